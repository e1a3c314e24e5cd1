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

std::string Gate::refusal(const RequestHead& head) const {
  if (head.method != "GET" && head.method != "POST") return "only GET and POST are served";
  if (head.host_headers != 1 || head.host != host_) return "the server is to be called by its own address";
  const bool is_own = head.origin == origin_;
  if (!head.origin.empty() && !is_own) return "pages of other sites are refused";
  if (!head.fetch_site.empty() && head.fetch_site != "same-origin" && head.fetch_site != "none") return "pages of other sites are refused";
  if (head.method == "GET" && is_first_path(head.target)) return "";
  if (head.target.size() < folder_.size() || !is_same_secret(head.target.substr(0, folder_.size()), folder_))
    return "the address lacks the token: use the whole address that steplap has printed";
  if (head.method == "POST" && !is_own) return "only the page itself may ask for that";
  if (head.method == "POST" && head.content_type != "application/json") return "what is posted must be JSON";
  return "";
}

bool Gate::is_first_use(const RequestHead& head) {
  if (is_taken_ || head.method != "GET" || !is_first_path(head.target)) return false;
  return is_taken_ = true;
}

} // namespace steplap
