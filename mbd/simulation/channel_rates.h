// Which channel is the rate of which.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Of each channel of a body's, marker's or joint's motion the one that is its rate; −1 where there is none.
[[nodiscard]] std::vector<int> rates_of(const System& system);

} // namespace steplap
