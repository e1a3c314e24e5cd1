#include "run/estimate.h"

#include "run/prominence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// A part takes some 40 to 300 ns, where much slides more.
constexpr double k_little = 1e7; // parts evaluated
constexpr double k_most = 3.0;   // times that: finer runs that turn out to need more are given up

Estimate none(EstimateStatus status, std::string reason) { return {status, std::move(reason), {}, {}}; }

} // namespace

Estimate estimate_errors(const Run& run, const RunOptions& options) {
  if (run.failure || (options.stop && !options.stop().empty())) return none(EstimateStatus::left_out, "the run broke off");
  if (options.estimating == Estimating::never) return none(EstimateStatus::left_out, "left out as asked");
  const LoadedModel& loaded = *run.loaded;
  const SimulationOptions as_run = simulation_options(loaded, options);
  const RunStatistics& statistics = run.result.statistics;
  double most_evaluations = std::numeric_limits<double>::infinity();
  if (options.estimating == Estimating::cheap) {
    const double times = times_of_finer_runs(*loaded.system, as_run), parts = parts_evaluated(*loaded.system, statistics);
    if (!(times * parts < k_little))
      return {EstimateStatus::too_dear, "would take long; ask for it explicitly", times * statistics.cpu_seconds, {}};
    most_evaluations = std::floor(k_most * k_little * static_cast<double>(statistics.evaluations) / std::max(parts, 1.0));
  }
  try {
    const State initial = options.start ? *options.start : initial_state_of(loaded);
    GlobalErrorEstimate errors = estimate_global_error(*loaded.system, initial, as_run, run.result, is_main_event, most_evaluations);
    Estimate estimate{EstimateStatus::known, "", {}, std::move(errors)};
    try {
      estimate.balance = balance_of(*loaded.system, initial, as_run, run.result, most_evaluations);
    } catch (const NumericalFailure& failure) { // the errors are known all the same
      estimate.balance_unknown = failure.what();
    }
    return estimate;
  } catch (const EstimateTooDear& stopped) {
    return none(EstimateStatus::too_dear, std::string(stopped.what()) + "; ask for it explicitly");
  } catch (const NumericalFailure& failure) {
    return none(EstimateStatus::failed, std::string("the finer run failed: ") + failure.what());
  }
}

} // namespace steplap
