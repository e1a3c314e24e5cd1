// The screen of one run: verdict and reason, what happened, what came nearest to its limit, how far to trust it, where the rest is.
// At most 30 lines of 100 columns.
#pragma once

#include "tools/steplap/shown_run.h"

#include <iosfwd>

namespace steplap {

/// `is_coloured`: verdict and warnings, for a terminal. With all digits lines are as long as they need be.
void print_overview(std::ostream& out, const ShownRun& run, bool is_coloured, bool has_all_digits = false);
/// Of several, one below the other; in colour where `out` takes it.
void print_overviews(std::ostream& out, const std::vector<ShownRun>& runs, bool has_all_digits = false);

} // namespace steplap
