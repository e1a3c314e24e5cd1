// Text as people are shown it: what a terminal would take for a command is spelled out, numbers have the digits that matter,
// and one of a thing is not called several.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace steplap {

/// Does the text hold a control character (line break, tab, escape, delete, …)?
[[nodiscard]] bool has_control_character(std::string_view text);
/// The text with control characters spelled out: "\n", "\t", "\x1b". `keeps_lines`: line breaks stay.
[[nodiscard]] std::string shown(std::string_view text, bool keeps_lines = false);

/// At most so many digits: "1e-11", where all that a double holds would be 1.0000000000000001e-11.
[[nodiscard]] std::string rounded_text(double value, int digits = 6);

/// "1 body", "2 bodies"
[[nodiscard]] std::string counted(std::size_t count, std::string_view one, std::string_view several);

} // namespace steplap
