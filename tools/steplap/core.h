// Command `steplap core MODEL`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command core_command();

} // namespace steplap
