#include "mbd/trust/reference_runs.h"

#include "mbd/base/number_text.h"
#include "mbd/trust/global_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

namespace {

constexpr const char* k_method = "auto";
// Tolerances of the references. rk4 at usual steps has errors of 1e-9 to 1e-4 of a range; an adaptive run has errors of ten to a hundred
// times its tolerance. A reference at 1e-11 costs little more than one at 1e-8, since samples and extremes dominate the cost. Below 1e-13
// rounding dominates.
constexpr double k_first_tolerance = 1e-9, k_tightening = 0.01;
constexpr double k_most_tolerance_of_last = 1e-12;
constexpr int k_division = 2;
constexpr double k_most_own_error = 1.0 / 3.0; // largest error of the reference, relative to the difference between run and reference
constexpr double k_safety = 1.5;               // because no error is exactly proportional to the tolerance
constexpr double k_parted = 0.01;              // difference that counts as divergence, relative to a range; 1e6 times the larger tolerance
constexpr double k_fewest_rows = 100.0;        // least number of samples of the coarser run, with which its oscillations are resolved
constexpr long k_steps_between_checks = 64;    // number of steps between checks of the cost

// Returns the options of the coarser run, which has every stride-th sample of the reference. If samples are few or do not include all
// channels, extremes are located in addition.
SimulationOptions thinned_out(SimulationOptions coarse, const System& system, const RunResult& run, std::size_t stride) {
  coarse.output_step *= static_cast<double>(stride);
  const bool has_all = run.trajectory->channels().size() == system.channels.size();
  coarse.has_extremes = !has_all || static_cast<double>(run.trajectory->size()) < k_fewest_rows;
  return coarse;
}

bool is_stepped(const RunResult& run) { return run.statistics.storms > 0; }

// Returns true if the reference's error is small compared with the difference between run and reference, in all kinds for which both are
// known.
bool is_fine_enough(const RunDifference& own, const RunDifference& of_run) {
  for (std::size_t k = 0; k < k_error_kinds; ++k)
    if (!std::isnan(of_run.worst[k].value) && !(own.worst[k].value <= k_most_own_error * of_run.worst[k].value)) return false;
  return true;
}

// One of a series of runs with decreasing tolerances.
struct LadderRun {
  SimulationOptions options;
  RunResult run;
};

// Returns `fine` as reference, with its error estimated from the difference to `coarse`.
ReferenceRuns pair_of(const LadderRun& coarse, const LadderRun& fine, std::size_t stride, const System& system,
                      const EventFilter& is_counted) {
  ReferenceRuns pair;
  pair.stride = stride;
  pair.own = compare_runs(system, coarse.run, fine.run, is_counted, stride);
  const bool has_same_events = pair.own.unmatched_events == 0;
  pair.factor = has_same_events ? k_safety * k_tightening / (1.0 - k_tightening) : 1.0;
  for (WorstError& worst : pair.own.worst) worst.value *= pair.factor;
  pair.parted_at = parts_at(system, coarse.run, fine.run, stride, k_parted);
  return pair;
}

} // namespace

RunResult EvaluationBudget::simulate(const System& system, const State& initial, const SimulationOptions& options, double most_of_run) {
  const double most = std::min(most_of_run, left());
  Simulation simulation(system, initial, options);
  const auto count = [&](const RunStatistics& run) {
    spent_.steps += run.steps;
    spent_.evaluations += run.evaluations;
    spent_.cpu_seconds += run.cpu_seconds;
  };
  try {
    for (long steps = 0; simulation.advance(); ++steps)
      if (steps % k_steps_between_checks == 0 && static_cast<double>(simulation.statistics().evaluations) > most)
        throw EvaluationBudgetExceeded("aborted after " + number_text(std::min(most_of_run, most_)) +
                                       " evaluations, at t = " + number_text(simulation.state().t) + " s of a finer run");
  } catch (const NumericalFailure&) {
    count(simulation.statistics());
    throw;
  }
  RunResult result = std::move(simulation).result();
  count(result.statistics);
  return result;
}

std::optional<ReferenceRuns> reference_runs(const System& system, const State& initial, const SimulationOptions& options,
                                            const RunResult& run, const EventFilter& is_counted, double most_evaluations,
                                            EvaluationBudget& budget) {
  const auto spent_before = static_cast<double>(budget.spent().evaluations);
  const auto left = [&] { return most_evaluations - (static_cast<double>(budget.spent().evaluations) - spent_before); };
  std::size_t stride = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(run.trajectory->size()) / k_fewest_rows));
  SimulationOptions next = options;
  next.integrator = k_method;
  next.settings.step = 0.0; // the method chooses its first step; from a very short given one, both runs would increase their steps alike
  next.settings.tolerance = k_first_tolerance;
  LadderRun coarse{thinned_out(next, system, run, stride), {}}, fine;
  std::optional<ReferenceRuns> best;
  try { // if the next run fails or is too expensive, the earlier ones are used
    coarse.run = budget.simulate(system, initial, coarse.options, left());
    for (;;) {
      // Other limits on the steps are divided as well. Otherwise both runs could take the same steps and have no difference.
      next.settings.division *= k_division;
      next.settings.tolerance *= k_tightening;
      LadderRun finer{next, budget.simulate(system, initial, next, left())};
      const RunResult& before = best ? fine.run : coarse.run;
      if (is_stepped(before) || is_stepped(finer.run) || finer.run.statistics.steps <= before.statistics.steps) break;
      if (best) {
        coarse = std::move(fine);
        stride = 1;
      }
      fine = std::move(finer);
      best = pair_of(coarse, fine, stride, system, is_counted);
      best->of_run = compare_runs(system, run, fine.run, is_counted);
      const bool is_known = !best->parted_at && is_fine_enough(best->own, best->of_run);
      if (is_known || next.settings.tolerance < k_most_tolerance_of_last) break;
    }
  } catch (const EvaluationBudgetExceeded&) {
    // what has been found decides
  } catch (const NumericalFailure&) {
    // Where adaptive steps end, as at a pole of a force, fixed steps may pass over what ended them; their own halves agree with them.
    if (!best) throw;
  }
  if (!best) return {};
  best->coarse_options = std::move(coarse.options);
  best->options = std::move(fine.options);
  best->coarse = std::move(coarse.run);
  best->reference = std::move(fine.run);
  return best;
}

} // namespace steplap
