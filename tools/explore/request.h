// Requests of a page to the server, and replies.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

namespace steplap {

/// A request that the server's gate (gate.h) has permitted.
struct PageRequest {
  bool is_post = false; ///< true for POST, false for GET
  std::string path;     ///< path after the token: "run"; "" for the page itself
  std::string query;    ///< text after the question mark, not decoded
  std::string body;     ///< content of the request, at most LocalServer::k_longest_body bytes
  /// Becomes true when the client closes the connection, after which no reply is needed.
  std::shared_ptr<const std::atomic<bool>> is_gone = std::make_shared<std::atomic<bool>>(false);
};

/// Reply to a request.
struct PageReply {
  int status = 200; ///< HTTP status
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string policy{};   ///< value of the header Content-Security-Policy; "": nothing may be loaded or executed
  std::string location{}; ///< redirect target for status 303
};

/// Sends the reply. Must be called once, from any thread.
using SendReply = std::function<void(PageReply)>;

} // namespace steplap
