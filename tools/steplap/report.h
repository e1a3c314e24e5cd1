// Command `steplap report RESULT…`.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

/// Writes the report of the runs in `folders` to `file`. Throws UsageError, FileError.
void write_report(const std::vector<std::string>& folders, const std::string& file, bool is_overwriting);

} // namespace steplap
