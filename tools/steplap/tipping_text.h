// Prints the margins against tipping as a table.
#pragma once

#include "mbd/run/tipping.h"

#include <iosfwd>

namespace steplap {

/// Prints all parts that can tip, and the parts that could not be judged. Prints nothing if no part stands on feet.
void print_tipping(std::ostream& out, const LoadedModel& loaded, const State& state);

} // namespace steplap
