// Name patterns with wildcards, as used in models for channels and events.
#pragma once

#include <string>

namespace steplap {

/// Returns true if all of `name` matches `pattern`: * stands for any text, ? for one character.
[[nodiscard]] bool matches_pattern(const std::string& name, const std::string& pattern);

} // namespace steplap
