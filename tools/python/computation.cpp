#include "tools/python/computation.h"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace steplap::python {

namespace {

std::atomic<int> g_running{0};
std::atomic<bool> g_is_exiting{false};

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void stop_all() {
  g_is_exiting = true;
  const py::gil_scoped_release unlocked;
  while (g_running > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

} // namespace

std::string Interruption::ask() {
  constexpr double k_between = 0.05; // interval between checks, s: not noticed by a user, and long compared with the cost of a check
  if (g_is_exiting) return "the Python interpreter exits";
  const double now = seconds();
  if (raised_ || now - asked_ < k_between) return raised_ ? "interrupted" : "";
  asked_ = now;
  const py::gil_scoped_acquire locked;
  if (PyErr_CheckSignals() != 0) raised_ = std::make_shared<py::error_already_set>();
  return raised_ ? "interrupted" : "";
}

void Interruption::raise_if_any() {
  if (raised_) throw py::error_already_set(*raised_);
}

Unlocked::CountedComputation::CountedComputation() {
  if (g_is_exiting) throw std::runtime_error("the Python interpreter exits");
  ++g_running;
}

Unlocked::CountedComputation::~CountedComputation() { --g_running; }

void add_computation(py::module_&) {
  // A forked child process has none of its parent's computations.
  ::pthread_atfork(nullptr, nullptr, [] { g_running = 0; });
  py::module_::import("atexit").attr("register")(py::cpp_function(stop_all));
}

} // namespace steplap::python
