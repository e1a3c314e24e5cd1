// Sentences for messages about directions without stiffness at an equilibrium.
#pragma once

#include "mbd/rest/equilibrium.h"

namespace steplap {

/// Returns one sentence for each direction. Bodies that are free along the same coordinate share a sentence.
[[nodiscard]] std::vector<std::string> indifference_texts(const System& system, const std::vector<MotionPart>& parts);

} // namespace steplap
