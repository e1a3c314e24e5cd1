// Check that the fields of a [[core]] are complete and consistent.
#pragma once

#include "transformer/core/core.h"

namespace steplap {

/// Returns all errors, each with the location of its field. If there are none, the core is valid input for CoreGeometry.
[[nodiscard]] std::vector<Diagnostic> check_dimensions(const Core& core);

} // namespace steplap
