// Symbols with which elements are drawn, by the names of their kinds. To draw a new kind, add one function and one line to the table in
// symbols.cpp; fields are read by name, so no element header is needed.
#pragma once

#include "mbd/run/sketch.h"

#include <string>

namespace steplap {

/// Draws the symbol of one kind.
using Symbol = void (*)(Sketch& sketch);

/// Returns the symbol of a kind by its name; nullptr if it has none.
[[nodiscard]] Symbol symbol_of(const std::string& kind);

} // namespace steplap
