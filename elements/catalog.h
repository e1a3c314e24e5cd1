// The list of all kinds of elements and signals. A new kind needs a line here.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// All kinds that are not special to transformers. Constant, made at first use.
[[nodiscard]] const Catalogue& element_catalog();

} // namespace steplap
