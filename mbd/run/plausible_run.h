// Finds implausible results of a run: an equilibrium far from the given poses, limits far from all values, parts that have left the part in
// which they began.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/run/findings.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Returns a note if the run began in equilibrium and a body moved by more than 0.01 of its size or 0.05 rad to reach it.
[[nodiscard]] std::vector<Finding> distant_rest_findings(const LoadedModel& loaded, const RunResult& result);
/// Returns a finding for each friction element that slid in the search for the equilibrium in which the run begins: a warning if a criterion
/// forbids its slips, because no event reports this one, otherwise a note.
[[nodiscard]] std::vector<Finding> start_slides(const LoadedModel& loaded, const Equilibrium& rest);
/// The same before a run: searches for the equilibrium. Returns nothing if there is none.
[[nodiscard]] std::vector<Finding> start_slides(const LoadedModel& loaded);
/// Returns a note for each criterion whose limit, given without a unit, is a thousand times larger than the largest value of its channel
/// and larger than all values of that unit in the run: its unit may be wrong.
[[nodiscard]] std::vector<Finding> distant_limit_findings(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);
/// Returns a warning for each part that no joint guides and that began inside the outline of another part but ended across its edge.
[[nodiscard]] std::vector<Finding> parts_outside(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
