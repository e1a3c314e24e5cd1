// Finds formulas of time (forces, and rates of states) that have no effect within a run but would have one after its end, or would reach
// their full size only then.
//
// Each formula is evaluated at the final state of the run for other times: within the run and up to k_behind times its length. A short
// pulse after the end may fall between two sample times.
#pragma once

#include "mbd/run/findings.h"

namespace steplap {

/// Returns true if a formula of the element depends explicitly on time. False for actions.
[[nodiscard]] bool uses_time(const ElementEntry& entry);
/// Returns one finding for each element whose formula has a late effect.
[[nodiscard]] std::vector<Finding> late_formulas(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
