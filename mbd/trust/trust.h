// Can what a run says be so?
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"

#include <string>

namespace steplap {

/// Why the run is not to be trusted, and what to try; empty: no reason is known. Energy made or lost beyond what the method's
/// errors can be, an hundredth of what was turned over (mbd/simulation/energy_account.h); joints that a step left wide open,
/// whatever projection made of them; coordinates so large that their rounding is a motion; loads passed over.
[[nodiscard]] std::string distrust_of(const Model& model, const System& system, const RunResult& result);

} // namespace steplap
