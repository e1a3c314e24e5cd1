// Formulas of the time that do nothing within a run and would do something behind its end, or come to their full size there.
//
// They are evaluated at the last state of the run with other times: over the run, and behind it up to k_behind times its length.
// Assumed is that what a formula does with the time alone shows at that state. A pulse behind the end may fall between two looks.
#pragma once

#include "run/findings.h"

namespace steplap {

/// One finding for each element with such a formula.
[[nodiscard]] std::vector<Finding> late_formulas(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
