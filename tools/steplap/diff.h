// steplap diff: what differs between two models, or between two runs and what led to it.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command diff_command();

} // namespace steplap
