// Converts numbers to text: the shortest decimal text that reads back as the same double, identical on every machine.
#pragma once

#include <cstddef>
#include <string>

namespace steplap {

/// Returns the shortest decimal text that reads back as `value`, for example "0.1", "1e-05", "nan", "inf".
[[nodiscard]] std::string number_text(double value);
/// Appends number_text(value) to `text`, without a temporary string.
void append_number(std::string& text, double value);

/// Buffer size for write_number(), bytes. Larger than the longest text, because digits are stored in blocks of eight.
inline constexpr std::size_t k_number_room = 48;
/// Writes number_text(value) to `at`, where k_number_room bytes must be writable. Returns the end of the text.
[[nodiscard]] char* write_number(char* at, double value);

} // namespace steplap
