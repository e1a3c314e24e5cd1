// Initial state of a run: on the joints, and in equilibrium if the model requests it.
#pragma once

#include "mbd/model/model.h"
#include "mbd/rest/equilibrium.h"

namespace steplap {

/// Returns the initial state of a run of `model`, from which `system` was compiled. Throws ModelError if the joints cannot be satisfied,
/// NumericalFailure if the model requests an equilibrium and there is none.
[[nodiscard]] State start_of(const Model& model, const System& system);
/// Returns the same state if `assembled`, the result of assemble(), is known already.
[[nodiscard]] State start_of(const Model& model, const System& system, const State& assembled);

/// Returns the equilibrium found from the assembled poses at zero velocity; the initial velocities are restored in the result. Throws
/// NumericalFailure if there is no equilibrium.
[[nodiscard]] Equilibrium equilibrium_at_start(const System& system, const State& assembled);

} // namespace steplap
