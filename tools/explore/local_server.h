// A web server for one user of this computer: HTTP on 127.0.0.1 behind a gate (gate.h), single-threaded, with limits on all resources.
#pragma once

#include "tools/explore/gate.h"
#include "tools/explore/request.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace steplap {

/// HTTP server that passes each permitted request to a function, which may reply at once or later.
class LocalServer {
public:
  static constexpr std::size_t k_longest_body = 1U << 18U;   ///< bytes of a request body
  static constexpr std::size_t k_longest_header = 1U << 15U; ///< size of the header, including the address with its query, bytes
  static constexpr int k_most_connections = 64;              ///< largest number of connections; further ones are closed at once
  static constexpr int k_patience = 30;                      ///< timeout for a whole request, and between requests, s
  /// Interval between calls of `tick`, ms.
  static constexpr int k_tick = 100;

  /// Called on the thread of run() for each request that the gate permits.
  using Answer = std::function<void(PageRequest, SendReply)>;

  /// Listens on 127.0.0.1. `port` 0 means any free port. Throws FileError if the port is in use.
  LocalServer(unsigned short port, Answer answer);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  /// Returns the address for a browser: "http://127.0.0.1:PORT/TOKEN/".
  [[nodiscard]] std::string address() const;
  /// Returns an address for a single use (Gate::first_path()).
  [[nodiscard]] std::string first_address() const;
  /// Serves until `tick` returns false or stop() is called, then closes all connections.
  void run(const std::function<bool()>& tick);
  /// Stops run(). Can be called from any thread.
  void stop();

private:
  struct Implementation;
  std::shared_ptr<Implementation> implementation_;
};

} // namespace steplap
