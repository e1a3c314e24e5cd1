// Command `steplap channels MODEL`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command channels_command();

} // namespace steplap
