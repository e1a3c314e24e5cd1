// Measures the error of a run with fixed steps by two adaptive runs.
//
// Runs with half and a quarter of the step share the errors of all fixed steps and cost six times the run. An adaptive run does neither.
// The reference has a tolerance of 1e-11, a second run 1e-9. Their difference gives the error of the reference, which is added to the run's
// difference from the reference:
//
//   |run − truth| ≤ |run − reference| + |reference − truth|
//
// If the second term exceeds a third of the first in positions, velocities, reactions or event times, both tolerances are reduced to a
// hundredth, once. The run with the larger tolerance locates no extremes and has few samples, because its difference enters with a small
// factor only.
//
// From the time at which the two references diverge, the motion depends on the last digits and no error is known. If they have different
// events, their difference does not follow the tolerance and counts in full.
#pragma once

#include "mbd/simulation/simulation.h"
#include "mbd/trust/run_comparison.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace steplap {

/// Limit on the evaluations of all finer runs together. Unlike a limit of time, it does not depend on the speed of the computer.
class EvaluationBudget {
public:
  explicit EvaluationBudget(double most) : most_(most) {}

  /// Simulates a run. Throws EvaluationBudgetExceeded if the run needs more evaluations than are left, or more than `most_of_run`.
  [[nodiscard]] RunResult simulate(const System& system, const State& initial, const SimulationOptions& options,
                                   double most_of_run = std::numeric_limits<double>::infinity());
  /// Returns the total cost of all runs so far, including aborted ones.
  [[nodiscard]] const RunStatistics& spent() const { return spent_; }
  /// Returns the number of evaluations left.
  [[nodiscard]] double left() const { return most_ - static_cast<double>(spent_.evaluations); }

private:
  double most_;
  RunStatistics spent_;
};

/// A reference run, with an estimate of its own error from a second run at a larger tolerance.
struct ReferenceRuns {
  SimulationOptions coarse_options, options; ///< options of `coarse` and `reference`
  RunResult coarse, reference;
  std::size_t stride = 1;          ///< `coarse` has every stride-th sample of `reference`
  double factor = 0.0;             ///< ratio of the reference's error to the difference of the two runs
  RunDifference own;               ///< error of the reference, scaled as in run_comparison.h
  RunDifference of_run;            ///< difference between the run and the reference, scaled in the same way
  std::optional<double> parted_at; ///< time from which the two runs diverge, s
};

/// Returns the references for `run`, which was made from `initial` with `options`, by fixed steps of a method that locates events. Returns
/// nothing if the references would exceed `most_evaluations` or the budget, if they fail or need time stepping, or if both take the same
/// steps.
[[nodiscard]] std::optional<ReferenceRuns> reference_runs(const System& system, const State& initial, const SimulationOptions& options,
                                                          const RunResult& run, const EventFilter& is_counted, double most_evaluations,
                                                          EvaluationBudget& budget);

} // namespace steplap
