// Friction along a line that sticks with more than it can hold: a fault of the event finder or of the mode problem, which no run passes
// over. Of step-lap joints Simulation::check_holding() does the same.
#pragma once

#include "mbd/dynamics/load_sharing.h"

#include <vector>

namespace steplap {

/// At the end of a step, t in s. `watch`: all watch values there; of friction along a line bound − λ and bound + λ, whose sizes together are
/// what it is judged against; of a one-way clutch the side alone that has a bound. `sharing`: null if nothing shares loads; what does is judged with its group. Throws ElementFailure.
void check_sticking(const System& system, const State& state, const LoadSharing* sharing, double t, const std::vector<double>& watch);

} // namespace steplap
