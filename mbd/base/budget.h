// Limits of wall time and memory for a computation, checked by a StopQuestion (stop.h) that the computation calls while it runs.
#pragma once

#include "mbd/base/stop.h"

#include <optional>

namespace steplap {

/// Limits of a computation.
struct Budget {
  std::optional<double> time;   ///< wall time, s
  std::optional<double> memory; ///< resident memory of the whole process, bytes
};

/// Returns a function that gives the reason to stop: that of `otherwise`, or that the budget is used up; "" to continue. The time is
/// counted from this call. Memory is read from /proc/self/statm, at most every 10 ms; without that file it is not limited.
[[nodiscard]] StopQuestion within(const Budget& budget, StopQuestion otherwise);

} // namespace steplap
