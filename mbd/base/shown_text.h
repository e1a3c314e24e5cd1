// Text for people: control characters escaped, numbers rounded to the digits that matter, singular and plural.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace steplap {

/// Returns true if the text contains a control character (line break, tab, escape, delete, …).
[[nodiscard]] bool has_control_character(std::string_view text);
/// Returns the text with control characters escaped as "\n", "\t", "\x1b", so that names from files cannot control a terminal.
/// `keeps_lines`: line breaks are not escaped.
[[nodiscard]] std::string shown(std::string_view text, bool keeps_lines = false);

/// Returns `value` with at most `digits` significant digits: "1e-11" rather than 1.0000000000000001e-11.
[[nodiscard]] std::string rounded_text(double value, int digits = 6);

/// Returns the count with the noun in the right number: "1 body", "2 bodies".
[[nodiscard]] std::string counted(std::size_t count, std::string_view one, std::string_view several);

} // namespace steplap
