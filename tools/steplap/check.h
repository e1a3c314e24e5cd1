// Command `steplap check MODEL…`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command check_command();

} // namespace steplap
