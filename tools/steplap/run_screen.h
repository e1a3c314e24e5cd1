// The tables of a run, or of several side by side: all events, extremes, joints, criteria, errors and residuals.
#pragma once

#include "tools/steplap/shown_run.h"

#include <iosfwd>

namespace steplap {

/// Of two or more events stand one below the other, everything else in one table with a column for each run.
void print_tables(std::ostream& out, const std::vector<ShownRun>& runs);

} // namespace steplap
