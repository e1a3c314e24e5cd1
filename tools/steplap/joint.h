// Command `steplap joint MODEL`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command joint_command();

} // namespace steplap
