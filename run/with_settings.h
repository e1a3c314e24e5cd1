// A loaded model with other settings than its file gives: method, tolerance, step, end and output step.
#pragma once

#include "run/loaded_model.h"
#include "run/run_options.h"

namespace steplap {

/// The model with the settings that `options` give, as load_model() makes it with "simulation.tolerance=1e-09" and the like as
/// overrides: compiled anew, with its text and its overrides. The same model if none is given, or if it has them already.
/// Throws ModelError with all that is wrong with the settings, and where a record has changed since the model was loaded.
[[nodiscard]] std::shared_ptr<const LoadedModel> with_settings(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options);

} // namespace steplap
