// List of all kinds of elements and signals. A new kind needs a line in catalog.cpp.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Returns all kinds that are not specific to transformers. Constant; made on the first call.
[[nodiscard]] const Catalogue& element_catalog();

} // namespace steplap
