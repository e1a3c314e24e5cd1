// Command `steplap elements [KIND]`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command elements_command();

} // namespace steplap
