// Sub-commands of `steplap study`.
#pragma once

#include "tools/steplap/command_line.h"
#include "tools/study/ranks.h"

namespace steplap::study {

/// Returns run, show, report, export, replay and schema. `ranks` must outlive them.
[[nodiscard]] std::vector<Command> study_commands(const Ranks& ranks);
/// Returns the program with these commands and its own exit codes.
[[nodiscard]] Program study_program(const Ranks& ranks);

} // namespace steplap::study
