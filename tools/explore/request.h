// What a page asks of the server, and what it gets.
#pragma once

#include <functional>
#include <string>

namespace steplap {

/// A request that has passed the server's gate (gate.h).
struct PageRequest {
  bool is_post = false; ///< else GET
  std::string path;     ///< behind the token: "run"; "" of the page itself
  std::string query;    ///< behind the question mark, as sent
  std::string body;     ///< at most LocalServer::k_longest_body bytes
};

/// What is sent back.
struct PageReply {
  int status = 200; ///< of HTTP
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string policy{};   ///< Content-Security-Policy; "": nothing may be loaded or run
  std::string location{}; ///< where to go on, of a status of 303
};

/// To be called once, from any thread.
using SendReply = std::function<void(PageReply)>;

} // namespace steplap
