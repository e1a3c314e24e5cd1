// The screen of one run: verdict and reason, what happened, what came nearest to its limit, how far to trust it, where the rest is.
// At most 30 lines of 100 columns.
#pragma once

#include "run/overview.h"

#include <iosfwd>
#include <string>

namespace steplap {

/// `folder`: of its results. `is_coloured`: verdict and warnings, for a terminal. With all digits lines are as long as they need be.
void print_overview(std::ostream& out, const Report& report, const std::string& folder, bool is_coloured, ShownDigits digits = {});
/// Is `out` the standard output on a terminal, and does NO_COLOR not forbid colour?
[[nodiscard]] bool takes_colour(const std::ostream& out);

} // namespace steplap
