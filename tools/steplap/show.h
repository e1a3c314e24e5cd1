// Command `steplap show RESULT…`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command show_command();

} // namespace steplap
