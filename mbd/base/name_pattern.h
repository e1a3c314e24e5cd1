// Patterns of names, as models write them for channels and events.
#pragma once

#include <string>

namespace steplap {

/// Does `name` match the pattern, * any text, ? any one character?
[[nodiscard]] bool matches_pattern(const std::string& name, const std::string& pattern);

} // namespace steplap
