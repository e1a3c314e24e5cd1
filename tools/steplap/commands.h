// List of all sub-commands. New ones are added here.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] std::vector<Command> all_commands();

} // namespace steplap
