// The command line: arguments in, exit code out.
#pragma once

#include "tools/steplap/command.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace steplap {

/// Runs `arguments` (without the program's name). `is_terminal`: `err` is one, progress may be shown.
/// Every error is reported on `err`; never throws. Returns the exit code (command.h).
int run_command_line(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err, bool is_terminal);

/// At the end of a program: what was to be said has been written, or that is an error, too. Returns the exit code.
int code_of_output(std::ostream& out, std::ostream& err, int code);

/// A program of several commands.
struct Program {
  std::string name, doc;
  std::vector<Command> commands;
  std::string exit_codes{}; ///< what help says of them; those of `steplap` if there is nothing
};

/// Is there a command of that name?
[[nodiscard]] bool is_command(const Program& program, const std::string& word);

/// The same for a program with other commands.
int run_program(const Program& program, const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err, bool is_terminal);

} // namespace steplap
