// Under which licences the program may be used and passed on.
#pragma once

#include <string_view>

namespace steplap {

/// LICENSE and THIRD_PARTY.md, as they were when the program was built.
extern const std::string_view k_licences;

} // namespace steplap
