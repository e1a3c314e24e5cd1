// Command `steplap help`: prints the help of one command or of all.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

/// Returns the entry for the list of commands. The parser executes it, because only the parser knows all options (command_line.cpp).
[[nodiscard]] Command help_command();

} // namespace steplap
