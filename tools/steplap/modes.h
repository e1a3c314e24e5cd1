// steplap modes: natural frequencies, damping and shapes of the small vibrations about equilibrium.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command modes_command();

} // namespace steplap
