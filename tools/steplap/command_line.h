// Parses the command line and runs the command.
#pragma once

#include "tools/steplap/command.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace steplap {

/// Runs `arguments` (without the program's name) and returns the exit code (command.h). Errors are reported on `err`; never throws.
/// `is_terminal` states that `err` is a terminal, on which progress may be shown.
int run_command_line(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err, bool is_terminal);

/// Flushes the output at the end of a program. Returns `code`, or an error code if the output could not be written.
int code_of_output(std::ostream& out, std::ostream& err, int code);

/// A program with several commands.
struct Program {
  std::string name, doc;
  std::vector<Command> commands;
  std::string exit_codes{}; ///< description of the exit codes in the help; "": that of `steplap`
};

/// Returns true if the program has a command of that name.
[[nodiscard]] bool is_command(const Program& program, const std::string& word);

/// As run_command_line(), for another program.
int run_program(const Program& program, const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err, bool is_terminal);

} // namespace steplap
