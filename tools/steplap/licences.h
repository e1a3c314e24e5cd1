// Licences of the program and of its parts.
#pragma once

#include <string_view>

namespace steplap {

/// LICENSE and THIRD_PARTY.md at the time of the build.
extern const std::string_view k_licences;

} // namespace steplap
