// Applies other settings to a loaded model: method, tolerance, step, end and output step.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/run_options.h"

namespace steplap {

/// Returns the model with the settings of `options`, as if load_model() had read it with overrides such as "simulation.tolerance=1e-09":
/// recompiled, with updated text and overrides. Returns the same model if no setting differs. Throws ModelError with all errors of the
/// settings, or if a record file has changed since the model was loaded.
[[nodiscard]] std::shared_ptr<const LoadedModel> with_settings(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options);

} // namespace steplap
