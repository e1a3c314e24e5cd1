// What followed from a change: two runs compared by their summaries and events.
#pragma once

#include "tools/steplap/shown_run.h"
#include "tools/steplap/text_table.h"

#include <iosfwd>

namespace steplap {

/// "+12 %"; what began at zero has no such number.
[[nodiscard]] Cell change_cell(double before, double after);

/// Tables of what differs by more than both errors together; where errors were not estimated, by more than rounding, which is said. Returns how many differences there are.
std::size_t print_result_changes(std::ostream& out, const ShownRun& before, const ShownRun& after);

} // namespace steplap
