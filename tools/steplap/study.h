// Command `steplap study`: starts the separate program ../libexec/steplap-study, which links the libraries for studies.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

/// Replaces this process by the study program. `words` are its arguments, from "study" to a terminating null. Returns an exit code only if
/// the program cannot be started.
int run_study_program(char** words);
/// As above, for arguments in a vector.
int run_study_program(const std::vector<std::string>& arguments);

} // namespace steplap
