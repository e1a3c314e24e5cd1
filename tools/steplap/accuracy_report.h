// Output of an accuracy study: a table for the screen, CSV, and a work–precision diagram.
#pragma once

#include "mbd/trust/accuracy_study.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace steplap {

/// Prints the table. `wanted` are errors; the last line names the cheapest setting that reaches each.
void print_accuracy(std::ostream& out, const AccuracyStudy& study, const std::vector<double>& wanted);
/// Returns CSV text with one row per entry. Fields of unresolved errors and of failed entries are empty.
[[nodiscard]] std::string accuracy_csv(const AccuracyStudy& study);
/// Returns an SVG diagram of CPU time over error, both logarithmic, with one line per integrator. Pareto-optimal entries are filled; the
/// resolution of the reference is a dashed line.
[[nodiscard]] std::string work_precision_svg(const AccuracyStudy& study, const std::string& title);

} // namespace steplap
