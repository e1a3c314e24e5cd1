// One increment of a load that grows slowly, from one equilibrium to the next (ramped_rest.h).
#pragma once

#include "mbd/rest/equilibrium.h"

namespace steplap {

/// Returns the equilibrium near `before`, an equilibrium under slightly different loads. Friction sticks at its place in `before` while its
/// bound allows; else it slides, at the bound for the normal forces of the new equilibrium. `sliding` lists what slides at the end, `slid`
/// also what slid on the way. Throws NumericalFailure if there is no equilibrium near by.
[[nodiscard]] Equilibrium rest_after_increment(const System& system, const Equilibrium& before);

} // namespace steplap
