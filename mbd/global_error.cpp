#include "mbd/global_error.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr double k_finer_tolerance = 0.01;
constexpr double k_least_tolerance = 1e-14; // below it rounding makes the steps
constexpr double k_finer_step = 0.5;

// What is left of the error in the second run. For fixed steps that of an order-1 method, the
// lowest there is: across events whose place in a step is arbitrary no method of higher order keeps
// its 2⁻ᵖ step for step.
double remaining_part(const SimulationOptions& coarse, const SimulationOptions& fine) {
  if (fine.settings.step != coarse.settings.step) return 0.5;
  return std::min(0.5, fine.settings.tolerance / coarse.settings.tolerance);
}

} // namespace

bool is_adaptive(const System& system, const std::string& integrator) {
  const Dynamics dynamics(system);
  IntegratorSettings settings;
  settings.step = 1e-3; // any: it makes no step
  return make_integrator(integrator, dynamics, settings)->is_adaptive();
}

SimulationOptions finer_options(const System& system, const SimulationOptions& options) {
  SimulationOptions finer = options;
  finer.progress = {};
  if (is_adaptive(system, options.integrator))
    finer.settings.tolerance =
        std::max(k_least_tolerance, k_finer_tolerance * options.settings.tolerance);
  else
    finer.settings.step = k_finer_step * options.settings.step;
  return finer;
}

GlobalErrorEstimate estimate_global_error(const System& system, const State& initial,
                                          const SimulationOptions& options, const RunResult& run,
                                          const EventFilter& is_counted) {
  GlobalErrorEstimate estimate;
  estimate.finer = finer_options(system, options);
  const RunResult second = simulate(system, initial, estimate.finer);
  estimate.cost = second.statistics;
  estimate.error = compare_runs(system, run, second, is_counted);
  const double part = remaining_part(options, estimate.finer);
  for (WorstError& worst : estimate.error.worst)
    worst.value /= 1.0 - part;
  return estimate;
}

} // namespace steplap
