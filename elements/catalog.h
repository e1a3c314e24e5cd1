// All kinds of elements and signals: the one list that a new kind is added to.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

[[nodiscard]] const Catalogue& element_catalog();

} // namespace steplap
