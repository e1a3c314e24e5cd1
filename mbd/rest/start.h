// Initial state of a run: on the joints, and in equilibrium if the model asks for it.
#pragma once

#include "mbd/model/model.h"
#include "mbd/rest/equilibrium.h"

namespace steplap {

/// Returns the initial state of a run of `model`, from which `system` was compiled. Throws ModelError if the joints cannot be satisfied,
/// NumericalFailure if the model asks for an equilibrium and there is none.
[[nodiscard]] State start_of(const Model& model, const System& system);
/// Returns the same from the result of assemble().
[[nodiscard]] State start_of(const Model& model, const System& system, const State& assembled);

/// Returns the equilibrium found from the assembled poses with zero velocity. The initial velocities are then restored in it. Throws
/// NumericalFailure if there is no equilibrium.
[[nodiscard]] Equilibrium equilibrium_at_start(const System& system, const State& assembled);

} // namespace steplap
