// Command `steplap plot RESULT… --channels …`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command plot_command();

} // namespace steplap
