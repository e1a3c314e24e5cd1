// steplap help: what --help says, of a command or of all.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

/// For the list of commands: the parser answers it, since it alone knows all options (command_line.cpp).
[[nodiscard]] Command help_command();

} // namespace steplap
