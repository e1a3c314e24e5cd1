// Computes the values of all channels for a machine at rest.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Returns the values in the order of System::channels, each in its unit. Drives that move at the time of `rest` are treated as held at
/// their position, so their forces are holding forces. `system` is changed during the call and restored afterwards.
[[nodiscard]] std::vector<double> values_at_rest(System& system, State rest);

} // namespace steplap
