// How far what stands is from tipping over, as a table.
#pragma once

#include "run/tipping.h"

#include <iosfwd>

namespace steplap {

/// Of those that stand, and what is not judged; nothing where nothing stands.
void print_tipping(std::ostream& out, const LoadedModel& loaded, const State& state);

} // namespace steplap
