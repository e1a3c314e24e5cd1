// Finds in a run what is hardly meant in its model: a rest far from the poses given, limits that nothing comes near, parts that have left
// the part they began in.
#pragma once

#include "mbd/trust/judgement.h"
#include "run/findings.h"

namespace steplap {

/// A note if the run began at rest, and rest lies far from the poses given: a hundredth of a body's size, or 0.05 rad.
[[nodiscard]] std::vector<Finding> far_rest(const LoadedModel& loaded, const RunResult& result);
/// A note for each criterion of the model whose limit, a number without a unit, is a thousand times beyond what its channel reached, and
/// beyond every value of that unit in the run.
[[nodiscard]] std::vector<Finding> far_limits(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);
/// A warning for each part that no joint guides, and that began in the outline of another and ends through its edge.
[[nodiscard]] std::vector<Finding> parts_outside(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
