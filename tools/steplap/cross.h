// Option `steplap check --cross`: runs every model with several independent integration and contact methods and reports differences between
// their results.
#pragma once

#include "mbd/run/run.h"
#include "tools/steplap/command.h"

namespace steplap {

/// Runs the methods and prints one table per model. All models together may use `cpu_limit`, s. Returns exit code 4 if results differ by
/// more than the error estimates, or if fewer than two methods gave a result.
[[nodiscard]] ExitCode cross_check_models(const std::vector<std::shared_ptr<const LoadedModel>>& models, double cpu_limit,
                                          Console& console);

} // namespace steplap
