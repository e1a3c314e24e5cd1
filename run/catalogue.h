// Everything a model file may use, unless a program brings a catalogue of its own: all kinds of elements and tables.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Made once, at first use; lives as long as the program.
[[nodiscard]] const Catalogue& program_catalogue();

} // namespace steplap
