// Command `steplap record`: reads a shock recorder's file and writes its layout, its events, and signals for models.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command record_command();

} // namespace steplap
