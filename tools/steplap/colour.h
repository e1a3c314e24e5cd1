// Whether what is shown may be coloured.
#pragma once

#include <iosfwd>

namespace steplap {

/// NO_COLOR is set (no-color.org), or the terminal is one that knows no colours.
[[nodiscard]] bool is_colour_refused();
/// Is `out` the standard output on a terminal, and is colour not refused?
[[nodiscard]] bool takes_colour(const std::ostream& out);

} // namespace steplap
