// Command `steplap equilibrium MODEL…`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command equilibrium_command();

} // namespace steplap
