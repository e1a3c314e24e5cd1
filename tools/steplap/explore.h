// Command `steplap explore`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command explore_command();

} // namespace steplap
