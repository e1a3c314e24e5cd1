// The program's version, as CMake knows it.
#pragma once

namespace steplap {

extern const char* const k_version; ///< "0.1.0"

} // namespace steplap
