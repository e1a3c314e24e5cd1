// Prints the summary of one run in at most 30 lines of 100 columns: verdict and reason, events, largest utilisations, reliability, location
// of the files.
#pragma once

#include "tools/steplap/shown_run.h"

#include <iosfwd>

namespace steplap {

/// `is_coloured` colours verdict and warnings. With all digits lines may be longer.
void print_overview(std::ostream& out, const ShownRun& run, bool is_coloured, bool has_all_digits = false);
/// Prints several summaries one below the other, coloured if `out` supports it.
void print_overviews(std::ostream& out, const std::vector<ShownRun>& runs, bool has_all_digits = false);

} // namespace steplap
