// A core as a core drawing shows it: elevation, section of the stack, the lines of a corner, the book across them.
#pragma once

#include "transformer/core/core.h"

#include <string>

namespace steplap {

/// An SVG image that stands alone. The elevation shows the limbs where the model has them; the book is drawn with its
/// layers some twenty times as thick as they are. Precondition: the model is valid.
[[nodiscard]] std::string core_svg(const Core& core, const Model& model);

} // namespace steplap
