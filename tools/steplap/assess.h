// steplap assess: what loads did to a machine, or would do.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command assess_command();

} // namespace steplap
