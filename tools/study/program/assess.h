// Executes `steplap assess`: reads, runs, decides, writes assessment.json and prints the result.
#pragma once

#include "tools/steplap/assess.h"

namespace steplap {

[[nodiscard]] ExitCode run_assessment(const AssessOptions& options, Console& console);

} // namespace steplap
