// The command line: arguments in, exit code out.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace steplap {

/// Runs `arguments` (without the program's name). `is_terminal`: `err` is one, progress may be shown.
/// Every error is reported on `err`; never throws. Returns the exit code (command.h).
int run_command_line(const std::vector<std::string>& arguments, std::ostream& out,
                     std::ostream& err, bool is_terminal);

} // namespace steplap
