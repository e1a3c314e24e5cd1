// What nothing holds at rest, in words.
#pragma once

#include "mbd/rest/equilibrium.h"

namespace steplap {

/// A sentence for one direction, and one for all bodies that are free along the same coordinate.
[[nodiscard]] std::vector<std::string> indifference_texts(const System& system, const std::vector<MotionPart>& parts);

} // namespace steplap
