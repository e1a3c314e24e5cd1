#include "tools/explore/peer_user.h"

#include <netinet/in.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace steplap {

namespace {

constexpr const char* k_established = "01"; // TCP_ESTABLISHED

// Returns the address of a socket in the kernel's notation: the bytes in network order, printed as a number in host order.
std::string socket_text(unsigned short port) {
  char text[16];
  std::snprintf(text, sizeof text, "%08X:%04X", static_cast<unsigned>(htonl(INADDR_LOOPBACK)), static_cast<unsigned>(port));
  return text;
}

} // namespace

std::optional<unsigned> user_of_connection(const std::string& table, unsigned short from, unsigned short to) {
  const std::string own = socket_text(from), other = socket_text(to);
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string number, local, remote, state, queues, timer, retransmissions;
    unsigned user = 0;
    fields >> number >> local >> remote >> state >> queues >> timer >> retransmissions >> user;
    if (fields && local == own && remote == other && state == k_established) return user;
  }
  return std::nullopt;
}

std::string tcp_table() {
  std::ifstream file("/proc/net/tcp");
  std::ostringstream text;
  text << file.rdbuf();
  return file ? text.str() : std::string();
}

} // namespace steplap
