// Catalogue of all kinds of elements and tables that a model file may use. Programs can replace it by their own.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Returns the catalogue. It is created at first use and lives until the program ends.
[[nodiscard]] const Catalogue& program_catalogue();

} // namespace steplap
