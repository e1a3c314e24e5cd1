// Prints the summary of one run in at most 30 lines of 100 columns: verdict and reason, events, largest utilisations, reliability, location
// of the files.
#pragma once

#include "tools/steplap/shown_run.h"

#include <iosfwd>

namespace steplap {

/// How the summary is printed.
struct OverviewStyle {
  bool is_coloured = false;    ///< true: verdict and warnings are coloured
  bool has_all_digits = false; ///< lines may then be longer than 100 columns
  bool has_warnings = true;    ///< false if the screen has shown the warnings before
};

/// Prints the summary of one run.
void print_overview(std::ostream& out, const ShownRun& run, const OverviewStyle& style);
/// Prints several summaries one below the other, coloured if `out` supports it.
void print_overviews(std::ostream& out, const std::vector<ShownRun>& runs, OverviewStyle style = {});

} // namespace steplap
