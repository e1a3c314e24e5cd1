// Command `steplap schema`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command schema_command();

} // namespace steplap
