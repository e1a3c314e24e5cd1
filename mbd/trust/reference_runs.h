// Two adaptive runs by which the error of a run with fixed steps is measured.
//
// Half the step and a quarter of it share with the run what all fixed steps share, and take six times its cost. An adaptive run shares
// neither. The reference is made at a tolerance of 1e-11, another run at a hundred times that; what these two differ by tells the
// reference's own error, which the run's error adds to what it differs from the reference by:
//
//   |run − truth| ≤ |run − reference| + |reference − truth|
//
// If the second part is more than a third of the first, in positions, velocities, reactions or times of events, both tolerances
// become a hundredth, once. The run at the larger tolerance looks for no extremes and has few samples: its difference is
// multiplied by a small part only.
//
// From the time at which the two references part, the motion depends on the last digits, and no error of it is known. If they have
// different events, their difference does not follow the tolerance, and counts in full.
#pragma once

#include "mbd/simulation/simulation.h"
#include "mbd/trust/run_comparison.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace steplap {

/// Limit of what finer runs may take together, in evaluations: a computer may be fast or slow.
class EvaluationBudget {
public:
  explicit EvaluationBudget(double most) : most_(most) {}

  /// Throws EstimateTooDear if the run takes more than what is left, or than `most_of_run`.
  [[nodiscard]] RunResult simulate(const System& system, const State& initial, const SimulationOptions& options,
                                   double most_of_run = std::numeric_limits<double>::infinity());
  /// Returns the cost of all runs so far, including those that were given up.
  [[nodiscard]] const RunStatistics& spent() const { return spent_; }
  /// Evaluations.
  [[nodiscard]] double left() const { return most_ - static_cast<double>(spent_.evaluations); }

private:
  double most_;
  RunStatistics spent_;
};

/// The reference, and what is known of its own error.
struct ReferenceRuns {
  SimulationOptions coarse_options, options; ///< of `coarse` and `reference`
  RunResult coarse, reference;
  std::size_t stride = 1;          ///< `coarse` has every so many samples of `reference`
  double factor = 0.0;             ///< the reference's own error over the difference of the two
  RunDifference own;               ///< that own error, scaled as in run_comparison.h
  RunDifference of_run;            ///< what the run differs from the reference by, scaled in the same way
  std::optional<double> parted_at; ///< s: from there on the two go different ways
};

/// References of `run`, which was made from `initial` with `options`: fixed steps of a method that locates events. Empty: they would
/// take more than `most_evaluations` or more than is left of the budget, they fail or need time stepping, or both take the same steps.
[[nodiscard]] std::optional<ReferenceRuns> reference_runs(const System& system, const State& initial, const SimulationOptions& options,
                                                          const RunResult& run, const EventFilter& is_counted, double most_evaluations,
                                                          EvaluationBudget& budget);

} // namespace steplap
