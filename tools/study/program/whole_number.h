// Whole numbers of options.
#pragma once

#include <limits>
#include <string>

namespace steplap {

/// Parses a whole number from `least` to `most`. Throws UsageError with the name of the option and both bounds for anything else.
[[nodiscard]] long whole_number(const std::string& text, const char* option, long least, long most = std::numeric_limits<long>::max());

} // namespace steplap
