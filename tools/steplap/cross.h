// `steplap check --cross`: every model run by methods that share little, and what they disagree on.
#pragma once

#include "run/run.h"
#include "tools/steplap/command.h"

namespace steplap {

/// Runs and prints one table for each model, all of them within `cpu_limit`, s. Exit code 4 if anything disagrees beyond the estimates, or if there are
/// no two opinions.
[[nodiscard]] ExitCode cross_check_models(const std::vector<std::shared_ptr<const LoadedModel>>& models, double cpu_limit,
                                          Console& console);

} // namespace steplap
