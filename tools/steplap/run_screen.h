// Prints the tables of one or several runs: events, extremes, joints, criteria, errors and residuals.
#pragma once

#include "tools/steplap/shown_run.h"

#include <iosfwd>

namespace steplap {

/// Prints the tables. For several runs the events are listed one run after the other; all other tables have one column for each run.
void print_tables(std::ostream& out, const std::vector<ShownRun>& runs);

} // namespace steplap
