// Runs a loaded model to its end, or until it fails.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/run/failure.h"
#include "mbd/run/loaded_model.h"
#include "mbd/run/run_options.h"
#include "mbd/simulation/simulation.h"

namespace steplap {

/// Outcome of a run. It owns the model and the system to which pointers in `result` refer.
struct Run {
  std::shared_ptr<const LoadedModel> loaded; ///< never nullptr
  RunResult result;                          ///< results up to the failure, if there was one
  std::optional<Failure> failure;            ///< reason for an early end; empty if the run reached its end
  std::optional<Equilibrium> rest;           ///< equilibrium in which the run began, if it was searched for
};

/// Returns the options of a simulation with the settings of the model. Precondition: the settings of `options` have been applied to the
/// model (with_settings.h). Throws std::invalid_argument for invalid options.
[[nodiscard]] SimulationOptions simulation_options(const LoadedModel& loaded, const RunOptions& options);

/// Runs the model with the settings of `options`. Throws ModelError if these settings are invalid (with_settings.h), NumericalFailure only
/// if the run cannot start.
[[nodiscard]] Run run_model(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options = {});

/// Returns true if nothing moved in the run, apart from rounding. No channel then has a range to which an error could be related.
[[nodiscard]] bool is_at_rest(const Run& run);

} // namespace steplap
