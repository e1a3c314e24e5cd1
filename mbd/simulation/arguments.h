// Checks of the arguments of a run that a calling program supplies. Those of model files are checked when the file is read.
#pragma once

#include "mbd/simulation/simulation.h"

namespace steplap {

/// Returns the options unchanged. Throws std::invalid_argument, naming the invalid option, if a run from time `start`, s, cannot use them.
[[nodiscard]] SimulationOptions checked(SimulationOptions options, double start);
/// Returns the state unchanged. Throws std::invalid_argument if it does not belong to `system` or contains numbers that are not finite.
[[nodiscard]] const State& checked(const State& state, const System& system);

} // namespace steplap
