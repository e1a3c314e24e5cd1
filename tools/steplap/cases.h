// Command `steplap cases MODEL`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command cases_command();

} // namespace steplap
