// Limits of time and memory of a computation, as a question that it asks while it runs.
#pragma once

#include "mbd/base/stop.h"

#include <optional>

namespace steplap {

/// Limits of a computation.
struct Budget {
  std::optional<double> time;   ///< wall time, s
  std::optional<double> memory; ///< resident memory of the whole process, bytes
};

/// Returns a question that is answered when the budget is used up, or when `otherwise` is answered. The time runs from this call. Memory is
/// read from /proc/self/statm at most every 10 ms; where that file is missing, it is not limited.
[[nodiscard]] StopQuestion within(const Budget& budget, StopQuestion otherwise);

} // namespace steplap
