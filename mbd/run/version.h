// Version of the program, set by CMake.
#pragma once

namespace steplap {

extern const char* const k_version; ///< "0.1.0"

} // namespace steplap
