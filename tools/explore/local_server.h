// A web server for one user on this computer: HTTP on 127.0.0.1, behind a gate (gate.h), one thread, bounded in everything.
#pragma once

#include "tools/explore/gate.h"
#include "tools/explore/request.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace steplap {

/// Serves until it is told to end. What it is asked for is answered by a function, at once or later.
class LocalServer {
public:
  static constexpr std::size_t k_longest_body = 1U << 18U;   ///< bytes of a request
  static constexpr std::size_t k_longest_header = 1U << 15U; ///< bytes, the address with its query among them
  static constexpr int k_most_connections = 64;              ///< further ones are closed at once
  static constexpr int k_patience = 30;                      ///< s: for the whole of a request, and for the next one
  /// How often `tick` is called, ms.
  static constexpr int k_tick = 100;

  /// Called on the thread of run() for each request that has passed the gate.
  using Answer = std::function<void(PageRequest, SendReply)>;

  /// Listens on 127.0.0.1. `port` 0: any that is free. Throws FileError if the port is taken.
  LocalServer(unsigned short port, Answer answer);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  /// What a browser is given: "http://127.0.0.1:PORT/TOKEN/".
  [[nodiscard]] std::string address() const;
  /// An address that leads there once (Gate::first_path()).
  [[nodiscard]] std::string first_address() const;
  /// Serves until `tick` says false, or stop() is called. Then connections are closed.
  void run(const std::function<bool()>& tick);
  /// From any thread.
  void stop();

private:
  struct Implementation;
  std::shared_ptr<Implementation> implementation_;
};

} // namespace steplap
