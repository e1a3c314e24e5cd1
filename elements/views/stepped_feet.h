// Finds contacts at different heights that share one friction element. The friction force acts at one of them, so its lever arm is wrong
// for the others.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"

namespace steplap {

/// Returns one finding for each such coulomb_stick.
[[nodiscard]] std::vector<Finding> stepped_feet(const LoadedModel& loaded);

} // namespace steplap
