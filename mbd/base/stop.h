// Lets long computations be stopped from outside: by a signal, a time limit, or because their result is no longer needed.
#pragma once

#include "mbd/base/diagnostics.h"

#include <functional>
#include <string>

namespace steplap {

/// Thrown if the user stops a computation.
class RunStopped : public NumericalFailure {
public:
  /// Constructs the error with its message.
  using NumericalFailure::NumericalFailure;
};

/// Function that returns the reason why the computation must stop; "" if it continues.
using StopQuestion = std::function<std::string()>;

/// While an object of this class exists, throw_if_stopped() in the same thread calls `question`, which must outlive the object. If `question`
/// is empty, that of the enclosing scope remains in use.
class StopScope {
public:
  /// Keeps a reference to `question`.
  explicit StopScope(const StopQuestion& question);
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  ~StopScope();

private:
  const StopQuestion* before_;
};

/// Calls the question of the innermost scope and throws RunStopped if it returns a reason. `where` ends the message: "in the search for
/// rest".
void throw_if_stopped(const char* where);

} // namespace steplap
