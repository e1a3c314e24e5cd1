// A loaded model run to its end, or to what stopped it.
#pragma once

#include "mbd/simulation/simulation.h"
#include "run/failure.h"
#include "run/loaded_model.h"
#include "run/run_options.h"

namespace steplap {

/// What a run left behind; it keeps its model and system alive, into which the result's pointers lead.
struct Run {
  std::shared_ptr<const LoadedModel> loaded; ///< never nullptr
  RunResult result;                          ///< up to the failure, if there was one
  std::optional<Failure> failure;            ///< what stopped the run; none: it reached its end
};

/// Options of a simulation of the model by its own settings, which those of `options` have been laid over (with_settings.h). Throws std::invalid_argument for options that are none.
[[nodiscard]] SimulationOptions simulation_options(const LoadedModel& loaded, const RunOptions& options);

/// Runs the model, with the settings of `options` laid over it. Throws ModelError for settings that it cannot be run with
/// (with_settings.h), NumericalFailure only if nothing could be run.
[[nodiscard]] Run run_model(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options = {});

} // namespace steplap
