// Relation between channels and the channels of their time derivatives.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Returns for each channel of the motion of a body, marker or joint the index of the channel that is its rate; −1 for all others, and if no
/// channel has extremes, which alone need it.
[[nodiscard]] std::vector<int> rates_of(const System& system);

} // namespace steplap
