// Command `steplap modes`: natural frequencies, damping and shapes of small vibrations about equilibrium.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command modes_command();

} // namespace steplap
