#include "tools/steplap/interruption.h"

#include <poll.h>

#include <array>
#include <csignal>

namespace steplap {

namespace {

constexpr std::array k_signals = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};

volatile std::sig_atomic_t noted = 0;
std::array<struct sigaction, k_signals.size()> before{};

extern "C" void note_signal(int signal) {
  if (noted != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    return;
  }
  noted = signal;
}

const char* name_of_signal(int signal) {
  switch (signal) {
  case SIGINT: return "SIGINT";
  case SIGTERM: return "SIGTERM";
  case SIGXCPU: return "SIGXCPU (the limit of processor time)";
  default: return "SIGHUP";
  }
}

} // namespace

InterruptionGuard::InterruptionGuard() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < k_signals.size(); ++i) {
    sigaction(k_signals[i], nullptr, &before[i]);
    // nohup ignores SIGHUP, and a shell ignores SIGINT for background processes; both remain ignored.
    if (before[i].sa_handler != SIG_IGN) sigaction(k_signals[i], &action, nullptr);
  }
}

InterruptionGuard::~InterruptionGuard() {
  for (std::size_t i = 0; i < k_signals.size(); ++i) sigaction(k_signals[i], &before[i], nullptr);
}

void report_write_errors() {
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

void end_if_pipe_is_closed(int descriptor) {
  pollfd ends{descriptor, 0, 0};
  if (poll(&ends, 1, 0) != 1 || (ends.revents & POLLERR) == 0) return;
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
}

int recorded_signal() { return noted; }

std::string interruption() { return noted == 0 ? "" : std::string("stopped by ") + name_of_signal(noted); }

void end_by_recorded_signal() {
  if (noted == 0) return;
  std::signal(noted, SIG_DFL);
  std::raise(noted);
}

} // namespace steplap
