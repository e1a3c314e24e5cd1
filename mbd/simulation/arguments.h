// Checks of the arguments of a run that come from a program. Those from model files are checked when the file is read.
#pragma once

#include "mbd/simulation/simulation.h"

namespace steplap {

/// Returns the options. Throws std::invalid_argument, naming the invalid one, if a run from time `start` cannot use them.
[[nodiscard]] SimulationOptions checked(SimulationOptions options, double start);
/// Returns the state. Throws std::invalid_argument if it does not belong to `system` or contains numbers that are not finite.
[[nodiscard]] const State& checked(const State& state, const System& system);

} // namespace steplap
