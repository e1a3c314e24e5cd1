// Compares two runs by their summaries and events.
#pragma once

#include "tools/steplap/shown_run.h"
#include "tools/steplap/text_table.h"

#include <iosfwd>

namespace steplap {

/// Returns a cell such as "+12 %". It is empty if the value before is zero.
[[nodiscard]] Cell change_cell(double before, double after);

/// Prints tables of values that differ by more than the sum of both errors, or, if errors were not estimated, by more than rounding (which
/// is stated). Returns the number of differences.
std::size_t print_result_changes(std::ostream& out, const ShownRun& before, const ShownRun& after);

} // namespace steplap
