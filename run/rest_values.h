// What all channels say of a machine that rests.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// In the order of System::channels, each in its unit. Drives that move or accelerate at the time of `rest` are taken as held where
/// they are: what they take is what holding takes. `system` is changed while this works, and as before afterwards.
[[nodiscard]] std::vector<double> values_at_rest(System& system, State rest);

} // namespace steplap
