// Text about directions without resistance at an equilibrium.
#pragma once

#include "mbd/rest/equilibrium.h"

namespace steplap {

/// Returns one sentence for each direction; bodies free along the same coordinate share one.
[[nodiscard]] std::vector<std::string> indifference_texts(const System& system, const std::vector<MotionPart>& parts);

} // namespace steplap
