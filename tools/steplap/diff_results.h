// Compares two runs by their summaries and events.
#pragma once

#include "tools/steplap/shown_run.h"
#include "tools/steplap/text_table.h"

#include <iosfwd>

namespace steplap {

/// Returns a cell such as "+12 %". It is empty if the value before is zero.
[[nodiscard]] Cell change_cell(double before, double after);

/// Prints the changes of verdict, criteria and utilisations. Returns the number of differences. A value differs if it changed by more than
/// the sum of both errors, or by more than rounding if errors were not estimated.
std::size_t print_limit_changes(std::ostream& out, const ShownRun& before, const ShownRun& after);
/// As above, for step-lap joints, events and extremes, and for channels of one run only.
std::size_t print_other_changes(std::ostream& out, const ShownRun& before, const ShownRun& after);
/// States for each run whose errors were not estimated that differences may be errors.
void print_unknown_errors(std::ostream& out, const ShownRun& before, const ShownRun& after);

} // namespace steplap
