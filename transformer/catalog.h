// Catalogue of all kinds: those of element_catalog(), and the tables that only transformers have, such as [[core]].
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Returns the catalogue that the command line uses. Constant, created at first use.
[[nodiscard]] const Catalogue& transformer_catalog();

} // namespace steplap
