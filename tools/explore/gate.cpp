#include "tools/explore/gate.h"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace steplap {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = getrandom(bytes.data() + filled, bytes.size() - filled, 0);
    if (got < 0 && errno != EINTR) throw std::runtime_error(std::string("the system gives no random numbers: ") + std::strerror(errno));
    if (got > 0) filled += static_cast<std::size_t>(got);
  }
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4U];
    text += "0123456789abcdef"[byte & 15U];
  }
  return text;
}

bool is_same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

Gate::Gate(unsigned short port, std::string token)
    : host_("127.0.0.1:" + std::to_string(port)), origin_("http://" + host_), folder_("/" + std::move(token) + "/"),
      first_path_("/first/" + random_token()) {}

bool Gate::is_first_path(const std::string& target) const { return is_same_secret(target, first_path_); }

std::string Gate::refusal(const RequestHead& knock) const {
  if (knock.method != "GET" && knock.method != "POST") return "only GET and POST are served";
  if (knock.host_headers != 1 || knock.host != host_) return "the server is to be called by its own address";
  const bool is_own = knock.origin == origin_;
  if (!knock.origin.empty() && !is_own) return "pages of other sites are refused";
  if (!knock.fetch_site.empty() && knock.fetch_site != "same-origin" && knock.fetch_site != "none")
    return "pages of other sites are refused";
  if (knock.method == "GET" && is_first_path(knock.target)) return "";
  if (knock.target.size() < folder_.size() || !is_same_secret(knock.target.substr(0, folder_.size()), folder_))
    return "the address lacks the token: use the whole address that steplap has printed";
  if (knock.method == "POST" && !is_own) return "only the page itself may ask for that";
  if (knock.method == "POST" && knock.content_type != "application/json") return "what is posted must be JSON";
  return "";
}

bool Gate::takes_first(const RequestHead& knock) {
  if (is_taken_ || knock.method != "GET" || !is_first_path(knock.target)) return false;
  return is_taken_ = true;
}

} // namespace steplap
