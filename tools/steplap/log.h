// What the program says about itself while it works, one line each on the error stream:
// "steplap: warning: …". Tables and other results do not go through here.
#pragma once

#include "tools/steplap/console.h"

#include <string>

namespace steplap {

/// Sends the log to `err`, coloured on a terminal that takes colour.
void start_log(std::ostream& err, bool is_terminal);
/// quiet: errors only; verbose: details too.
void set_log_level(Verbosity verbosity);

void log_error(const std::string& text);
void log_warning(const std::string& text);
void log_info(const std::string& text);
void log_detail(const std::string& text);

} // namespace steplap
