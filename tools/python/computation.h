// Computations that release Python's interpreter lock (GIL). Ctrl-C and the exit of the interpreter stop them.
#pragma once

#include "mbd/base/stop.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace steplap::python {

namespace py = pybind11;

/// Checks at most 20 times per second whether Ctrl-C was pressed in Python, or whether the interpreter exits. Called without the GIL.
class Interruption {
public:
  /// Returns the reason to stop; "" lets the computation continue.
  [[nodiscard]] std::string ask();
  /// Raises KeyboardInterrupt, or the exception of another signal handler, if one was pending. Requires the GIL.
  void raise_if_any();

private:
  double asked_ = 0.0; ///< time of the last check on a steady clock, s
  std::shared_ptr<py::error_already_set> raised_;
};

/// Releases the GIL during its lifetime and delays the exit of the interpreter, which would otherwise end this thread within C++ code and
/// abort the process.
class Unlocked {
public:
  Unlocked() = default;
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked() = default;

private:
  struct CountedComputation {
    CountedComputation(); // throws std::runtime_error if the interpreter exits
    CountedComputation(const CountedComputation&) = delete;
    CountedComputation& operator=(const CountedComputation&) = delete;
    ~CountedComputation();
  };
  CountedComputation counted_; // first member, so that the computation is counted until the GIL is acquired again
  py::gil_scoped_release released_;
};

/// Returns the result of `work(stop)`, computed without the GIL. All long loops of the library poll `stop`, which has the type of
/// RunOptions::stop. Raises KeyboardInterrupt if Ctrl-C was pressed.
template <class Work> auto computed(const Work& work) {
  Interruption interruption;
  const StopQuestion stop = [&interruption] { return interruption.ask(); };
  try {
    auto result = [&] {
      const Unlocked unlocked;
      const StopScope scope(stop);
      return work(stop);
    }();
    interruption.raise_if_any();
    return result;
  } catch (const RunStopped&) {
    interruption.raise_if_any();
    throw;
  }
}

/// Registers a function that stops all computations and waits for them when the interpreter exits.
void add_computation(py::module_& module);

} // namespace steplap::python
