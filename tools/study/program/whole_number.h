// Whole numbers of options.
#pragma once

#include <limits>
#include <string>

namespace steplap {

/// Reads a whole number from `least` to `most`. Throws UsageError that names the option and both if it is none.
[[nodiscard]] long whole_number(const std::string& text, const char* option, long least, long most = std::numeric_limits<long>::max());

} // namespace steplap
