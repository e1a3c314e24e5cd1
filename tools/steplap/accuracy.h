// Command `steplap accuracy MODEL…`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command accuracy_command();

} // namespace steplap
