// Prints the margins against tipping as a table.
#pragma once

#include "mbd/run/tipping.h"

#include <iosfwd>

namespace steplap {

/// Prints all parts that can tip and those that are not judged. Prints nothing if nothing stands.
void print_tipping(std::ostream& out, const LoadedModel& loaded, const State& state);

} // namespace steplap
