// Finds formulas of time, of forces and of the rates of states, that have no effect within a run but would have one after its end, or would reach their full size only then.
//
// Each formula is evaluated at the final state of the run for other times: within the run and up to k_behind times its length. A short
// pulse after the end may fall between two sample times.
#pragma once

#include "mbd/run/findings.h"

namespace steplap {

/// Returns true if a formula of the element, which is no action, holds the time itself.
[[nodiscard]] bool uses_time(const ElementEntry& entry);
/// Returns one finding for each element with such a formula.
[[nodiscard]] std::vector<Finding> late_formulas(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
