// steplap study: its sub-commands.
#pragma once

#include "tools/steplap/command_line.h"
#include "tools/study/ranks.h"

namespace steplap::study {

/// run, show, report, export, replay, schema; `ranks` has to outlive them.
[[nodiscard]] std::vector<Command> study_commands(const Ranks& ranks);
/// The program of these, with its own exit codes.
[[nodiscard]] Program study_program(const Ranks& ranks);

} // namespace steplap::study
