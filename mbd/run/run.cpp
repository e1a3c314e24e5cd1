#include "mbd/run/run.h"

#include "mbd/base/number_text.h"
#include "mbd/base/stop.h"
#include "mbd/run/findings.h"
#include "mbd/run/with_settings.h"
#include "mbd/trust/global_error.h"

#include <stdexcept>

namespace steplap {

namespace {

void throw_if_stopped(const RunOptions& options, double t) {
  if (!options.stop) return;
  if (const std::string why = options.stop(); !why.empty()) throw RunStopped(why + " at t = " + number_text(t) + " s.");
}

} // namespace

SimulationOptions simulation_options(const LoadedModel& loaded, const RunOptions& options) {
  SimulationOptions simulation = options_of(loaded.model);
  simulation.has_extremes = options.has_extremes;
  simulation.progress = [options](double t) { throw_if_stopped(options, t); };
  return simulation;
}

Run run_model(std::shared_ptr<const LoadedModel> as_loaded, const RunOptions& options) {
  const StopScope stopping(options.stop);
  std::shared_ptr<const LoadedModel> loaded = with_settings(std::move(as_loaded), options);
  SimulationOptions simulation_asked = simulation_options(*loaded, options);
  const double fixed_step = is_adaptive(*loaded->system, simulation_asked.integrator) ? 0.0 : simulation_asked.settings.step;
  simulation_asked.notes_motion = options.estimating != Estimating::never; // recorded motion decides whether an equilibrium is stable
  bool is_over = false; // the run has failed; result() then still samples the last state, and must not be stopped
  simulation_asked.progress = [&is_over, &options](double t) {
    if (options.progress) options.progress(t);
    if (!is_over) throw_if_stopped(options, t);
  };
  // Running extremes are read for criteria only. They are up to 128 copies of the ranges of all channels, which large scenes do not have room for.
  simulation_asked.has_growth = options.has_extremes && is_judged(loaded->model);
  Run run;
  if (!options.start && loaded->model.simulation.initial == "equilibrium") run.rest = equilibrium_of(*loaded);
  const State start = options.start ? *options.start : run.rest ? run.rest->state : initial_state_of(*loaded);
  Simulation simulation(*loaded->system, start, std::move(simulation_asked));
  try {
    simulation.run();
  } catch (const NumericalFailure& failure) {
    run.failure = failure_of(failure, loaded->model, *loaded->system, 0.0);
    is_over = true;
  }
  run.result = std::move(simulation).result();
  if (run.failure && run.failure->kind == FailureKind::numerical)
    if (std::optional<Failure> named = formula_failure(run.result.final_state, fixed_step, loaded->model, *loaded->system))
      run.failure = std::move(named);
  if (run.failure) run.failure->t = run.result.final_state.t;
  run.loaded = std::move(loaded);
  return run;
}

bool is_at_rest(const Run& run) {
  const RunStatistics& s = run.result.statistics;
  return s.energy_exchanged <= s.energy_rounding && run.loaded->system->kinetic_energy(run.result.final_state) <= s.energy_rounding;
}

} // namespace steplap
