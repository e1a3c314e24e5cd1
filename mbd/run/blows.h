// Detects rigid impacts: an inextensible rope becomes taut, a clutch locks, or an action activates a joint between moving bodies.
//
// In a rigid impact velocities jump. Its impulse is known, but its force is not: 100 kN for 1 ms and 1 MN for 0.1 ms are the same impulse.
// Forces and accelerations would depend on a compliance that the model does not contain.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/run.h"
#include "mbd/trust/judgement.h"

#include <string_view>

namespace steplap {

/// First words of CriterionResult::doubt for a criterion that a rigid impact leaves open, in contrast to numerical errors.
inline constexpr std::string_view k_but_for_a_blow = "met except for a rigid impact";

/// Sets criteria from "hold" to "open" if a rigid impact makes their value unknown, and updates the verdict. Affected are limits on forces,
/// couples and accelerations of the elements and bodies that take part in the impact, and of all bodies connected to them by constraint
/// rows. Criteria that are not met are unchanged.
void leave_impacts_open(Judgement& judgement, const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
