// Draws a core as SVG: elevation, section through the stack, the step-lap lines of one corner and the book in a section across them.
#pragma once

#include "transformer/core/core.h"

#include <string>

namespace steplap {

/// Returns a self-contained SVG image. The elevation shows the limbs that the model contains. The layers of the book are drawn about twenty
/// times thicker than to scale. Precondition: the model is valid.
[[nodiscard]] std::string core_svg(const Core& core, const Model& model);

} // namespace steplap
