// All sub-commands: the one list that a new one is added to.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] std::vector<Command> all_commands();

} // namespace steplap
