// Everything a model file may use: the elements and signals of all rooms below the command line.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

[[nodiscard]] const Catalogue& program_catalogue();

} // namespace steplap
