// Fits text into the columns of a terminal. Widths count characters, not bytes, of UTF-8.
#pragma once

#include <cstddef>
#include <string>

namespace steplap {

/// Returns the number of characters.
[[nodiscard]] std::size_t width_of(const std::string& text);
/// Returns the text, shortened to `most` characters. The last character of a shortened text is "…".
[[nodiscard]] std::string cut(const std::string& text, std::size_t most);
/// Breaks a text at blanks, but not between a number and its unit, into at most `most_lines` lines of `columns` characters; all but the
/// first are indented. The last line is cut.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent, std::size_t most_lines);

} // namespace steplap
