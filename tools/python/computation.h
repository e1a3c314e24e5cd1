// Computations that leave the interpreter lock (GIL) to other Python threads, and that Ctrl-C and the end of the interpreter stop.
#pragma once

#include "mbd/base/stop.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace steplap::python {

namespace py = pybind11;

/// Checks at most twenty times a second whether Ctrl-C was pressed in Python, or whether the interpreter exits. Called without the GIL.
class Interruption {
public:
  /// Returns the reason to stop; "" lets the computation continue.
  [[nodiscard]] std::string ask();
  /// Raises KeyboardInterrupt, or the exception of a signal handler, if one occurred. Must be called with the GIL held.
  void raise_if_any();

private:
  double asked_ = 0.0; ///< time of the last check on a steady clock, s
  std::shared_ptr<py::error_already_set> raised_;
};

/// Releases the GIL while it exists. The interpreter does not exit meanwhile: it would end the thread in the middle of C++ code, which
/// aborts the process.
class Unlocked {
public:
  Unlocked() = default;
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked() = default;

private:
  struct Counted {
    Counted(); // throws std::runtime_error if the interpreter exits
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    ~Counted();
  };
  Counted counted_; // first: counted until the GIL is held again
  py::gil_scoped_release released_;
};

/// Returns the result of `work(stop)`, computed without the GIL. `stop` is polled by all long loops of the library, and may be given to
/// RunOptions. Raises KeyboardInterrupt if it was pressed meanwhile.
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

/// Stops all computations when the interpreter exits, and waits for them.
void add_computation(py::module_& module);

} // namespace steplap::python
