// Everything a model file may use, unless a program brings a catalogue of its own: the kinds of all rooms below this one.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Made once, at first use; lives as long as the program.
[[nodiscard]] const Catalogue& program_catalogue();

} // namespace steplap
