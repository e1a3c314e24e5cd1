// Finds motions that still go on where a run ends, and bodies that nothing carried in it.
#pragma once

#include "mbd/trust/judgement.h"
#include "run/findings.h"

namespace steplap {

/// Criteria whose value is still the worst of the run at its end, grows, and would reach its limit within one more run length at its
/// present rate; and criteria whose worst value has grown in each eighth of the second half, as that of a swing that builds up does, and
/// would reach the limit at the rate of the last.
[[nodiscard]] std::vector<Finding> growing_criteria(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);
/// A note of friction that slips and of contacts that have opened at the end, and that no criterion asks for.
[[nodiscard]] std::vector<Finding> open_at_end(const LoadedModel& loaded, const RunResult& result);
/// Bodies that fall: gravity pulls them, nothing that acts in the run leads from them to the ground but contacts that never closed, and no
/// criterion, force or drive names them.
[[nodiscard]] std::vector<Finding> bodies_that_fall(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
