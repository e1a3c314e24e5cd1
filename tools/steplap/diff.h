// Command `steplap diff`: differences between two models, or between two runs and their models.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command diff_command();

} // namespace steplap
