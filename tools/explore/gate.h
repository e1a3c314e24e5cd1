// Access control of the local server: only its own pages, and users who know its address, may send requests.
//
// The server listens on 127.0.0.1, where every program and every web page on this computer can reach it. Each request must therefore name
// the server as its host (which prevents DNS rebinding by another site), contain the secret token in its path, and not come from a page of
// another origin. The connection must belong to the user who started the server (peer_user.h), because the address is on the command line
// of the browser, which other users of the computer can read.
#pragma once

#include <string>

namespace steplap {

/// Parts of a request that are checked. Missing headers are "".
struct RequestHead {
  std::string method;       ///< "GET"
  std::string target;       ///< "/TOKEN/run?…"
  std::string host;         ///< header Host
  std::string origin;       ///< header Origin
  std::string fetch_site;   ///< header Sec-Fetch-Site
  std::string content_type; ///< header Content-Type
  int host_headers = 1;     ///< number of Host headers
};

/// Returns 32 hexadecimal digits from the system's random source. Throws std::runtime_error if it is not available.
[[nodiscard]] std::string random_token();

/// Returns true if both secrets are equal. Takes the same time for all secrets of one length, so that the time reveals nothing.
[[nodiscard]] bool is_same_secret(const std::string& a, const std::string& b);

/// Access rules of one server.
class Gate {
public:
  /// `token` is created by random_token().
  Gate(unsigned short port, std::string token);

  /// Returns "127.0.0.1:PORT".
  [[nodiscard]] const std::string& host() const { return host_; }
  /// Returns "http://127.0.0.1:PORT".
  [[nodiscard]] const std::string& origin() const { return origin_; }
  /// Returns "/TOKEN/".
  [[nodiscard]] const std::string& folder() const { return folder_; }
  /// Returns a path for a single use, which can be passed on the command line of a browser. The server redirects its first use to folder()
  /// and refuses further ones.
  [[nodiscard]] const std::string& first_path() const { return first_path_; }

  /// Returns the reason for refusing a request; "" if it is permitted. Requests for first_path() are always permitted here; is_first_use()
  /// checks them.
  [[nodiscard]] std::string refusal(const RequestHead& head) const;
  /// Returns true for the first request for first_path(), false for every later one.
  [[nodiscard]] bool is_first_use(const RequestHead& head);

private:
  [[nodiscard]] bool is_first_path(const std::string& target) const;

  std::string host_, origin_, folder_, first_path_;
  bool is_taken_ = false;
};

} // namespace steplap
