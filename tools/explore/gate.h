// Who may talk to the server: a page that it has sent itself, or somebody who was given its address.
//
// The server listens on 127.0.0.1, where every program and every web page of this computer can reach it. So each request has to
// name the server as its host (else a name of another site could have been pointed at 127.0.0.1), carry the token in its path (which
// no other site knows), and must not come from a page of another origin.
#pragma once

#include <string>

namespace steplap {

/// Of a request, what the gate looks at. Texts are "" where a header is missing.
struct Knock {
  std::string method;       ///< "GET"
  std::string target;       ///< "/TOKEN/run?…"
  std::string host;         ///< header Host
  std::string origin;       ///< header Origin
  std::string fetch_site;   ///< header Sec-Fetch-Site
  std::string content_type; ///< header Content-Type
  int host_headers = 1;     ///< how many headers Host there are
};

/// 32 hexadecimal digits from the system's source of randomness. Throws std::runtime_error if that gives none.
[[nodiscard]] std::string random_token();

/// Compares without telling by its time how far the texts agree.
[[nodiscard]] bool is_same_secret(const std::string& a, const std::string& b);

/// The rules of one server.
class Gate {
public:
  /// `token`: as random_token() makes it.
  Gate(unsigned short port, std::string token);

  /// "127.0.0.1:PORT"
  [[nodiscard]] const std::string& host() const { return host_; }
  /// "http://127.0.0.1:PORT"
  [[nodiscard]] const std::string& origin() const { return origin_; }
  /// "/TOKEN/"
  [[nodiscard]] const std::string& folder() const { return folder_; }
  /// An address that serves once, for a program's command line, which other users of the computer can read: the server leads from
  /// there to its folder. Whoever comes second is refused.
  [[nodiscard]] const std::string& first_path() const { return first_path_; }

  /// Why the request is refused, "" if it is not. One for first_path() is let through as often as it comes.
  [[nodiscard]] std::string refusal(const Knock& knock) const;
  /// Is it the first request for first_path()? Every later one is not.
  [[nodiscard]] bool takes_first(const Knock& knock);

private:
  [[nodiscard]] bool is_first_path(const std::string& target) const;

  std::string host_, origin_, folder_, first_path_;
  bool is_taken_ = false;
};

} // namespace steplap
