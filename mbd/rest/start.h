// Where the run of a model begins: on its joints, and at rest under its loads if it asks for that.
#pragma once

#include "mbd/model/model.h"
#include "mbd/rest/equilibrium.h"

namespace steplap {

/// The state a run of `model` begins at; `system` is compiled from it. Throws ModelError if its joints cannot be met,
/// NumericalFailure if it is to begin at an equilibrium and has none.
[[nodiscard]] State start_of(const Model& model, const System& system);
/// The same for whoever has called assemble() already.
[[nodiscard]] State start_of(const Model& model, const System& system, const State& assembled);

/// Where the bodies rest, found from the assembled poses without the initial velocities, which are given back with the
/// pose. Throws NumericalFailure if there is no equilibrium.
[[nodiscard]] Equilibrium equilibrium_at_start(const System& system, const State& assembled);

} // namespace steplap
