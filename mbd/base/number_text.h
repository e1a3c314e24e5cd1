// Numbers as text: the shortest digits that read back as the same double, the same on every
// machine.
#pragma once

#include <string>

namespace steplap {

/// "0.1", "1e-05", "nan", "inf".
[[nodiscard]] std::string number_text(double value);
/// The same, appended to `text`; for writing many.
void append_number(std::string& text, double value);

} // namespace steplap
