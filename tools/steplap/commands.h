// List of all sub-commands. Each is defined in the source file of its name. A new command is declared here and listed in commands.cpp.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] std::vector<Command> all_commands();

[[nodiscard]] Command new_command();
[[nodiscard]] Command simulate_command();
[[nodiscard]] Command explore_command();
[[nodiscard]] Command show_command();
[[nodiscard]] Command report_command();
[[nodiscard]] Command plot_command();
[[nodiscard]] Command record_command();
[[nodiscard]] Command cases_command();
[[nodiscard]] Command diff_command();
[[nodiscard]] Command check_command();
[[nodiscard]] Command equilibrium_command();
[[nodiscard]] Command modes_command();
[[nodiscard]] Command joint_command();
[[nodiscard]] Command core_command();
[[nodiscard]] Command accuracy_command();
[[nodiscard]] Command channels_command();
[[nodiscard]] Command elements_command();
[[nodiscard]] Command schema_command();
/// Returns the command for the program `steplap`: it executes --static and prints help (assess.h).
[[nodiscard]] Command assess_command();
/// Returns the entry for the list of commands. It is never executed, because main() starts the study program before the command line is
/// parsed.
[[nodiscard]] Command study_command();
/// Returns the entry for the list of commands. The parser executes it, because only the parser knows all options (command_line.cpp).
[[nodiscard]] Command help_command();

} // namespace steplap
