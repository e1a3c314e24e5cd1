// Status messages on the error stream, one line each: "steplap: warning: …". Results and tables do not use the log.
#pragma once

#include "tools/steplap/console.h"

#include <string>

namespace steplap {

/// Sends the log to `err`, coloured if the terminal supports it.
void start_log(std::ostream& err, bool is_terminal);
/// Sets which messages are shown. quiet: errors only; verbose: details, too.
void set_log_level(Verbosity verbosity);

void log_error(const std::string& text);
void log_warning(const std::string& text);
void log_info(const std::string& text);
void log_detail(const std::string& text);

} // namespace steplap
