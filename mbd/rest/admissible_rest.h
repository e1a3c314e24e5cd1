// Finds whether some admissible distribution of friction forces holds a machine at rest, and how close it is to the limit of friction.
//
// The force in a sticking contact depends on the history of loading: a ladder between wall and floor may carry its load at either end. So
// all distributions of the load over elastic contacts and friction are admitted. With small displacements δq along the joints, as large as
// contacts deform, and friction forces w:
//   Q + K δq + Jᵀλ + Fᵀw = 0,   |w_e| ≤ u c_e(δq),   N_c(δq) ≥ 0,
// where F are the rows of friction, c_e its capacities and N_c the normal forces, all linear in δq. The least u is found by bisection, with
// a linear program for each u (interior-point method: S. Boyd, L. Vandenberghe, Convex Optimization, 2004, ch. 11). The pose is moved by δq
// and all is linearised again, until nothing changes. If u ≤ 1, the machine can rest, and in the pose found no element uses more than the
// fraction u of its capacity. Friction of several dimensions is assumed to stick, which is checked afterwards.
#pragma once

#include "mbd/rest/statics.h"

#include <optional>

namespace steplap {

struct AdmissibleRest {
  State state;        ///< pose in which the largest utilisation of friction is least
  double usage = 0.0; ///< u; above 1 no distribution of forces is admissible
};

/// Searches near `state`, a pose in which forces balance with friction sticking. `scale`: displacement per scaled coordinate, as in
/// Descent::scale(); `length`: size of the model, m. Returns nothing if forces cannot balance, or only in a pose far away.
[[nodiscard]] std::optional<AdmissibleRest> admissible_rest(const System& system, const State& state, const VecX& scale, double length);

} // namespace steplap
