// The server over real sockets: connections of another user, and clients that close before they have their reply.
#include "tools/explore/explorer.h"
#include "tools/explore/local_server.h"
#include "tools/explore/peer_user.h"

#include <doctest/doctest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <future>
#include <string>
#include <thread>

using namespace steplap;

namespace {

// Serves on a free port until it is destroyed.
class Served {
public:
  explicit Served(LocalServer::Answer answer) : server_(0, std::move(answer)), thread_([this] { server_.run([] { return true; }); }) {}
  ~Served() {
    server_.stop();
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  // Address after "http://127.0.0.1:PORT", such as "/TOKEN/".
  [[nodiscard]] std::string path() const { return server_.address().substr(server_.address().find('/', 7)); }
  [[nodiscard]] std::string first_path() const { return server_.first_address().substr(server_.first_address().find('/', 7)); }
  [[nodiscard]] unsigned short port() const { return static_cast<unsigned short>(std::atoi(server_.address().c_str() + 17)); }
  [[nodiscard]] std::string get(const std::string& target) const {
    return "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port()) + "\r\nConnection: close\r\n\r\n";
  }

private:
  LocalServer server_;
  std::thread thread_;
};

// Returns a socket that has sent `request`, or -1. Calls only functions that are allowed after fork().
int send_request(unsigned short port, const std::string& request) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (socket < 0 || ::connect(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) return -1;
  return ::write(socket, request.data(), request.size()) == static_cast<ssize_t>(request.size()) ? socket : -1;
}

// Status of the reply, 0 if there is none.
int status_of(int socket) {
  char head[13] = {};
  std::size_t filled = 0;
  while (filled < 12) {
    const ssize_t got = ::read(socket, head + filled, 12 - filled);
    if (got <= 0) return 0;
    filled += static_cast<std::size_t>(got);
  }
  ::close(socket);
  return std::atoi(head + 9);
}

} // namespace

TEST_CASE("a connection's user is found in the system's table, and only while it is established") {
  const std::string head = "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode\n";
  char own[16], other[16];
  std::snprintf(own, sizeof own, "%08X:9C40", htonl(INADDR_LOOPBACK));
  std::snprintf(other, sizeof other, "%08X:1F90", htonl(INADDR_LOOPBACK));
  const auto line = [&](const char* from, const char* to, const char* state, int user) {
    return std::string("   1: ") + from + " " + to + " " + state + " 00000000:00000000 00:00000000 00000000 " + std::to_string(user) +
           "        0 4711 1 0000000000000000 20 4 30 10 -1\n";
  };
  CHECK(user_of_connection(head + line(other, own, "01", 0) + line(own, other, "01", 1000), 0x9c40, 0x1f90) == 1000);
  CHECK_FALSE(user_of_connection(head + line(own, other, "06", 0), 0x9c40, 0x1f90));    // TIME_WAIT
  CHECK_FALSE(user_of_connection(head + line(other, own, "01", 1000), 0x9c40, 0x1f90)); // the server's own end
  CHECK_FALSE(user_of_connection(head, 0x9c40, 0x1f90));
  CHECK_FALSE(user_of_connection("", 0x9c40, 0x1f90));
}

TEST_CASE("the page is served to its user and refused to every other") {
  const Served served([](const PageRequest&, const SendReply& send) { send({200, "text/plain", "page"}); });
  const std::string page = served.get(served.path()), first = served.get(served.first_path());
  const unsigned short port = served.port();
  if (::geteuid() == 0) { // another user is simulated by a child process
    const pid_t child = ::fork();
    if (child == 0) {
      if (::setuid(65534) != 0) ::_exit(1);
      const bool is_refused = status_of(send_request(port, first)) == 403 && status_of(send_request(port, page)) == 403;
      ::_exit(is_refused ? 0 : 2);
    }
    int status = -1;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
  } else {
    MESSAGE("not run as root: no second user to try");
  }
  CHECK(status_of(send_request(port, first)) == 303); // not used up by the other user
  CHECK(status_of(send_request(port, page)) == 200);
}

TEST_CASE("a client that closes its connection withdraws its request") {
  std::promise<PageRequest> asked;
  std::promise<SendReply> reply;
  const Served served([&](const PageRequest& request, const SendReply& send) {
    reply.set_value(send);
    asked.set_value(request);
  });
  const int socket = send_request(served.port(), served.get(served.path()));
  REQUIRE(socket >= 0);
  const PageRequest request = asked.get_future().get();
  CHECK_FALSE(*request.is_gone);
  ::close(socket);
  while (!*request.is_gone) std::this_thread::yield(); // for ever, if it is never noticed
  reply.get_future().get()({200, "text/plain", "nobody reads this"});
}

TEST_CASE("no model is run for a page that is gone") {
  Explorer explorer({std::string(STEPLAP_MODELS) + "/paper/no_interference.toml"}, {});
  const auto answered = [&](bool is_gone) {
    std::promise<PageReply> reply;
    PageRequest request;
    request.is_post = true;
    request.path = "run";
    request.body = R"({"model": 0, "values": {}, "page": "one"})";
    request.is_gone = std::make_shared<std::atomic<bool>>(is_gone);
    explorer.answer(request, [&reply](PageReply given) { reply.set_value(std::move(given)); });
    return reply.get_future().get().body;
  };
  CHECK(answered(true).find("is_superseded") != std::string::npos);
  CHECK(answered(false).find("is_superseded") == std::string::npos);
}
