#include "mbd/run/estimate.h"

#include "mbd/run/prominence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Limit for automatic estimates, in evaluated parts (evaluation_cost()). One part takes about 40 to 300 ns; with much sliding more.
constexpr double k_little = 1e7;
constexpr double k_decisive = 10.0; // multiple of the limit if the verdict depends on the estimate
constexpr double k_most = 3.0;      // finer runs that need more than k_most times the limit are abandoned
// If finer runs are too expensive, adaptive reference runs may still be cheap, when the run itself has many short steps. They may use at
// most as many evaluations as the run. If that is fewer than this number, they are not tried.
constexpr double k_least_references = 5000.0;
// The search for unstable equilibria by runs from a perturbed pose may use this many times the evaluations of the run, even if that exceeds
// the limit for automatic estimates, because the verdict depends on its result.
constexpr double k_nudged = 1.5;

Estimate none(EstimateStatus status, std::string reason) { return {status, std::move(reason), {}, {}}; }

} // namespace

Estimate estimate_errors(const Run& run, const RunOptions& options, bool is_decisive) {
  if (run.failure || (options.stop && !options.stop().empty())) return none(EstimateStatus::left_out, "the run broke off");
  if (options.estimating == Estimating::never) return none(EstimateStatus::left_out, "left out as asked");
  const LoadedModel& loaded = *run.loaded;
  const SimulationOptions as_run = simulation_options(loaded, options);
  const RunStatistics& statistics = run.result.statistics;
  double most_evaluations = std::numeric_limits<double>::infinity();
  std::optional<Estimate> too_expensive; // result if reference runs are not possible either
  if (options.estimating == Estimating::cheap && !(is_decisive && options.has_second_opinion)) {
    const double little = is_decisive ? k_decisive * k_little : k_little;
    const double times = relative_cost_of_finer_runs(*loaded.system, as_run), parts = evaluation_cost(*loaded.system, statistics);
    const double evaluations_a_part = static_cast<double>(statistics.evaluations) / std::max(parts, 1.0);
    most_evaluations = std::floor(k_most * little * evaluations_a_part);
    if (!(times * parts < little)) {
      too_expensive = none(EstimateStatus::too_expensive, "the estimate would take long; ask for it explicitly");
      too_expensive->cost = times * statistics.cpu_seconds;
      most_evaluations = std::floor(std::min(little, parts) * evaluations_a_part);
      if (!is_measured_by_references(*loaded.system, as_run.integrator) || most_evaluations < k_least_references)
        return *std::move(too_expensive);
    }
  }
  try {
    const State initial = options.start ? *options.start : initial_state_of(loaded);
    GlobalErrorEstimate errors = estimate_global_error(*loaded.system, initial, as_run, run.result, is_main_event, most_evaluations);
    Estimate estimate{EstimateStatus::known, "", {}, std::move(errors)};
    try {
      const double as_dear_as_the_run = k_nudged * static_cast<double>(statistics.evaluations);
      estimate.balance = balance_of(*loaded.system, initial, as_run, run.result, std::max(most_evaluations, as_dear_as_the_run));
    } catch (const NumericalFailure& failure) { // only stability is unknown; the errors are known
      estimate.balance_unknown = failure.what();
    }
    return estimate;
  } catch (const EvaluationBudgetExceeded& stopped) {
    if (too_expensive) return *std::move(too_expensive);
    return none(EstimateStatus::too_expensive, std::string(stopped.what()) + "; ask for it explicitly");
  } catch (const NumericalFailure& failure) {
    return none(EstimateStatus::failed, std::string("the finer run failed: ") + failure.what());
  }
}

} // namespace steplap
