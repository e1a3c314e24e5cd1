// Decides whether output may be coloured.
#pragma once

#include <iosfwd>

namespace steplap {

/// Returns true if NO_COLOR is set (no-color.org) or the terminal has no colours.
[[nodiscard]] bool is_colour_refused();
/// Returns true if `out` is the standard output on a terminal and colour is not refused.
[[nodiscard]] bool takes_colour(const std::ostream& out);

} // namespace steplap
