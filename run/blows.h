// Rigid blows: ropes without elasticity that become taut, clutches that lock, joints that an action closes on bodies that move.
//
// Velocities jump, and what joints the bodies has an impulse and no force: 100 kN for 1 ms are the same as 1 MN for 0.1 ms. How large forces
// and accelerations become depends on compliance that the model does not have.
#pragma once

#include "mbd/trust/judgement.h"
#include "run/loaded_model.h"
#include "run/run.h"

#include <string_view>

namespace steplap {

/// How doubts about such a criterion begin: they are none about numerical errors.
inline constexpr std::string_view k_but_for_a_blow = "met but for a rigid blow";

/// Criteria of forces, couples and accelerations through which a rigid blow went, and that are met without it, are open: what was
/// struck, and what is joined to that by constraints.
void leave_struck_open(Judgement& judgement, const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
