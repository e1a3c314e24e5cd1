// One increment of a load that grows slowly, from one equilibrium to the next (ramped_rest.h).
#pragma once

#include "mbd/rest/ramped_rest.h"

namespace steplap {

/// Returns the equilibrium near `before`, an equilibrium under slightly different loads. Friction sticks at its place in `before` while its
/// bound allows; else it slides, at the bound for the normal forces of the new equilibrium. `sliding` lists what slides at the end, `slid`
/// also what slid on the way. `may_creep`: if no set of sliding friction is consistent, follows the machine as it creeps, which costs some
/// hundred times more. Throws NumericalFailure if there is no equilibrium near by, RestNotFound if that is not known.
[[nodiscard]] RampedRest rest_after_increment(const System& system, const RampedRest& before, bool may_creep);

} // namespace steplap
