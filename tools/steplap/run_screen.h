// What a run, or several side by side, came to: one screen.
#pragma once

#include "run/report.h"

#include <iosfwd>

namespace steplap {

/// A run and where its files are.
struct FinishedRun {
  Report report;
  std::string folder;
};

void print_run(std::ostream& out, const FinishedRun& finished);
/// Two or more: events one below the other, everything else in one table with a column for each run.
void print_comparison(std::ostream& out, const std::vector<FinishedRun>& runs);

} // namespace steplap
