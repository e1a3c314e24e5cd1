// Lets long computations be stopped from outside: by a signal, a time limit, or because their result is no longer needed.
#pragma once

#include "mbd/base/diagnostics.h"

#include <functional>
#include <string>

namespace steplap {

/// Thrown if the user stops a computation.
class RunStopped : public NumericalFailure {
public:
  /// Takes the message.
  using NumericalFailure::NumericalFailure;
};

/// Returns the reason to stop, or "" to continue.
using StopQuestion = std::function<std::string()>;

/// While an object of this class exists, stop_if_asked() in the same thread asks `question`, which must outlive it. An empty question
/// leaves that of an enclosing scope in place.
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

/// Throws RunStopped if the question of the innermost scope has an answer. `where` ends the message: "in the search for rest".
void stop_if_asked(const char* where);

} // namespace steplap
