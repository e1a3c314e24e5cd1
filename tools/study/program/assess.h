// What `steplap assess` does: reads, runs, decides, writes assessment.json, tells it on a screen.
#pragma once

#include "tools/steplap/assess.h"

namespace steplap {

[[nodiscard]] ExitCode run_assessment(const AssessOptions& options, Console& console);

} // namespace steplap
