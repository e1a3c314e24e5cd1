// Checks whether the result of a run is physically possible.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"

#include <string>

namespace steplap {

/// Returns the reason why the run cannot be trusted, and what to try; empty if no reason is known. Possible reasons are:
/// - energy created or lost beyond the errors of the method, by more than a hundredth of the energy exchanged
///   (mbd/simulation/energy_account.h);
/// - joints that a step left wide open, even if projection closed them;
/// - coordinates so large that their rounding is a visible motion;
/// - loads that the steps passed over.
[[nodiscard]] std::string distrust_of(const Model& model, const System& system, const RunResult& result);

} // namespace steplap
