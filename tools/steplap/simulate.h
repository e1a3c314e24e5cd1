// Command `steplap simulate MODEL…`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command simulate_command();

} // namespace steplap
