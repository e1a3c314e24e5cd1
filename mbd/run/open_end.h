// Finds motions that continue at the end of a run, and bodies that fall freely.
#pragma once

#include "mbd/run/findings.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Returns a finding for each criterion that may still be violated after the end, for one of two reasons. Its value is the worst of the run
/// at the end and would reach the limit within one more run length, at its present rate and, for a coordinate of a body, acceleration; a
/// slide that goes on at the end, and places of the bodies that it moves, may go on for longer than that, until the slide ends. Or
/// its worst value has grown in each eighth of the second half of the run, as in a growing oscillation, and would reach the limit within
/// one more run length at the rate of the last eighth.
[[nodiscard]] std::vector<Finding> growing_criteria(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);
/// Returns a note for each friction element that slips and each contact that is open at the end, if no criterion refers to it.
[[nodiscard]] std::vector<Finding> open_at_end(const LoadedModel& loaded, const RunResult& result);
/// Returns a finding for each body that falls freely: gravity acts on it, its only connections to the ground are contacts that never
/// closed, and no force, drive or limit of a place or velocity names it.
[[nodiscard]] std::vector<Finding> bodies_that_fall(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
