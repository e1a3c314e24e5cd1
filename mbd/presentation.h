// What a model says about looking at its runs: [[plot]] and [[acceptance]].
//
// Neither changes the motion. Both name channels by patterns, which can only be compared with the
// channels that a compiled system has: check_presentation() does that.
#pragma once

#include "mbd/system.h"

namespace steplap {

[[nodiscard]] const TableKind& plot_kind();
[[nodiscard]] const TableKind& acceptance_kind();

/// Throws ModelError for patterns that no written channel or no element matches, and for a plot whose
/// channels are of different units.
void check_presentation(const Model& model, const System& system);

} // namespace steplap
