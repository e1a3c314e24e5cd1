// All that a model of a power transformer may contain: the elements' kinds and the tables of this room.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

[[nodiscard]] const Catalogue& transformer_catalog();

} // namespace steplap
