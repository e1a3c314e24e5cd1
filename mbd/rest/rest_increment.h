// One increment of a load that grows slowly, from one equilibrium to the next (ramped_rest.h).
#pragma once

#include "mbd/rest/equilibrium.h"

namespace steplap {

/// Returns the equilibrium near `start`, an equilibrium under slightly different loads: by Newton's method if all friction holds, by damped
/// time steps (settling.h) if some slides. `slid` lists friction that stuck at the start and has slid. Throws NumericalFailure if there is
/// no equilibrium near by.
[[nodiscard]] Equilibrium rest_after_increment(const System& system, const State& start);

} // namespace steplap
