// What a run, or several side by side, came to: one screen.
#pragma once

#include "tools/steplap/summary.h"

#include <iosfwd>

namespace steplap {

/// A run, what it came to and where its files are.
struct FinishedRun {
  Run run;
  RunSummary summary;
  std::string folder;
};

void print_run(std::ostream& out, const FinishedRun& finished);
/// Two or more: events one below the other, everything else in one table with a column for each run.
void print_comparison(std::ostream& out, const std::vector<FinishedRun>& runs);

} // namespace steplap
