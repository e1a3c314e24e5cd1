// What an accuracy study tells: a table for the screen, the same as CSV, a work–precision diagram.
#pragma once

#include "mbd/trust/accuracy_study.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace steplap {

/// `wanted`: errors for which the cheapest setting is named in the last line.
void print_accuracy(std::ostream& out, const AccuracyStudy& study, const std::vector<double>& wanted);
/// One row an entry; errors that are not resolved and those of failed entries are empty fields.
[[nodiscard]] std::string accuracy_csv(const AccuracyStudy& study);
/// CPU time over error, both logarithmic, one line an integrator, Pareto entries filled, the
/// resolution of the reference as a dashed line.
[[nodiscard]] std::string work_precision_svg(const AccuracyStudy& study, const std::string& title);

} // namespace steplap
