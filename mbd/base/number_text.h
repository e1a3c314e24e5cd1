// Numbers as text: the shortest digits that read back as the same double, the same on every
// machine.
#pragma once

#include <cstddef>
#include <string>

namespace steplap {

/// "0.1", "1e-05", "nan", "inf".
[[nodiscard]] std::string number_text(double value);
/// The same, appended to `text`; for writing many.
void append_number(std::string& text, double value);

/// Bytes that write_number() may touch: more than the longest number has.
inline constexpr std::size_t k_number_room = 48;
/// The same at `at`, where k_number_room bytes are free; returns the end of the text.
[[nodiscard]] char* write_number(char* at, double value);

} // namespace steplap
