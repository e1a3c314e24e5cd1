// Drawing and check functions of the element kinds that are not specific to transformers (mbd/run/kind_views.h).
#pragma once

#include "mbd/run/kind_views.h"

namespace steplap {

/// Returns the functions of all kinds of element_catalog().
[[nodiscard]] KindViews element_views();

} // namespace steplap
