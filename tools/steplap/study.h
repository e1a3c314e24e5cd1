// steplap study: handed over to the program that has the libraries of studies, ../libexec/steplap-study.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

/// Becomes that program, with the arguments behind "study" (`words` begins with that word and ends with null). Returns an
/// exit code only if it cannot be started.
int run_study_program(char** words);
/// The same with arguments at hand.
int run_study_program(const std::vector<std::string>& arguments);

/// For the list of commands: main() has handed over before the command line is read.
[[nodiscard]] Command study_command();

} // namespace steplap
