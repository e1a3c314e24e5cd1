// Are the fields of a [[core]] complete, and do they agree with each other?
#pragma once

#include "transformer/core/core.h"

namespace steplap {

/// All that is wrong, each at the field that it is about; empty: a CoreGeometry can be made of it.
[[nodiscard]] std::vector<Diagnostic> check_dimensions(const Core& core);

} // namespace steplap
