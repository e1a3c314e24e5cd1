// Is there an admissible set of friction forces in whose hold a machine rests, and how far is it from its border?
//
// Friction that sticks bears whatever it got when it got its load: a ladder between wall and floor may lean on either
// of its ends. What is admissible is a question of all the ways in which elastic contacts and friction can share the
// load. With poses that differ by as little as contacts give way, δq along the joints, and the friction forces w:
//   Q + K δq + Jᵀλ + Fᵀw = 0,   |w_e| ≤ u c_e(δq),   N_c(δq) ≥ 0,
// F the rows of friction, c_e its capacity and N_c the normal forces, all linear in δq. The least u is found by
// bisection, with a linear program for each u (an interior-point method: S. Boyd, L. Vandenberghe, Convex Optimization,
// 2004, ch. 11); the pose moves there, and all is linearised anew until nothing changes. u ≤ 1: it can rest, and in the
// pose found each element uses no more than u of what it can bear. Friction of several dimensions takes part as it is
// stuck; whether it holds is looked at afterwards.
#pragma once

#include "mbd/rest/statics.h"

#include <optional>

namespace steplap {

struct AdmissibleRest {
  State state;        ///< the pose in which friction uses least
  double usage = 0.0; ///< u; above 1: no set of forces is admissible
};

/// About `state`, a pose in which forces balance with friction stuck. `scale` per coordinate (Descent::scale): metres
/// for radians; `length`: of the scene. Nothing where the forces cannot balance, or only in a pose far off.
[[nodiscard]] std::optional<AdmissibleRest> admissible_rest(const System& system, const State& state, const VecX& scale, double length);

} // namespace steplap
