// Check that one-dimensional friction elements stick only within their bounds. A violation is an error of the event finder or of the mode
// problem, and ends the run. RunLeg::check_holding() does the same for step-lap joints.
#pragma once

#include "mbd/dynamics/load_sharing.h"

#include <vector>

namespace steplap {

/// To be called at the end of a step, at time t in s. `event_value` contains all event functions; for a sticking element these are bound −
/// λ and bound + λ, and a violation is relative to the sum of their magnitudes. For a one-way clutch only the bounded side counts. Elements
/// that share a load are checked as a group (`sharing`; null: none). Throws ElementFailure.
void check_sticking(const System& system, const State& state, const LoadSharing* sharing, double t, const std::vector<double>& event_value);

} // namespace steplap
