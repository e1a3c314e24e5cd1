// What a program hands to a run, looked at before it begins: from model files all of this is checked when they are read.
#pragma once

#include "mbd/simulation/simulation.h"

namespace steplap {

/// The options, if a run from time `start` can use them. Throws std::invalid_argument, which names what cannot be.
[[nodiscard]] SimulationOptions checked(SimulationOptions options, double start);
/// The state, if it is one of `system` and all its numbers are finite. Throws std::invalid_argument.
[[nodiscard]] const State& checked(const State& state, const System& system);

} // namespace steplap
