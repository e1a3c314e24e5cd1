// Measures the accuracy of integrators against their cost. Each entry of a list of settings (integrator with a tolerance or a step) is run
// and compared with a reference.
//
// The reference is computed by two independent methods at a tight tolerance. The difference of the two is the resolution: smaller errors of
// an entry cannot be measured. A kind of error (positions, velocities, reactions, event times) for which they differ by more than
// k_agreement is not reported. If they differ by more than that in positions, there is no reference and the study fails.
//
// Entries are run within a budget of CPU time, those with the least predicted cost first. Entries that exceed the budget are left out,
// which the table shows.
//
// The cost is the CPU time of one thread for a run without samples, the least of several runs. The error comes from another run with
// samples. Samples are interpolated, so both runs take the same steps.
#pragma once

#include "mbd/trust/run_comparison.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// An integrator with its tolerance, or with its step if it has fixed steps.
struct MethodSetting {
  std::string integrator;
  double value = 0.0;
  bool is_step = false; ///< value is a step, s

  /// Returns the setting as text, such as "dop853 1e-08" or "rk4 h = 0.0001 s".
  [[nodiscard]] std::string text() const;
  [[nodiscard]] SimulationOptions applied_to(SimulationOptions options) const;
};

struct AccuracyOptions {
  std::vector<MethodSetting> ladder;
  MethodSetting first_reference{"dop853", 1e-13}, second_reference{"tsit5", 1e-13};
  int repeats = 3;         ///< largest number of repetitions of a run to measure its time; long runs are repeated less often
  double cpu_limit = 60.0; ///< CPU time of one run, s; a longer run is stopped and reported as failed
  /// CPU time for the whole list, s. The references are run first and are not counted.
  double budget = std::numeric_limits<double>::infinity();
  EventFilter is_event_counted;                          ///< empty: all events
  std::function<void(const std::string& text)> progress; ///< called before each run with a text about it, if set
};

struct AccuracyEntry {
  MethodSetting setting;
  std::string failure;      ///< reason why there is no result; empty if there is one
  bool is_left_out = false; ///< not run, because it would have exceeded the budget
  double cpu_seconds = 0.0;
  RunStatistics cost; ///< statistics of a run without samples
  RunDifference error;
  double energy_residual = 0.0;     ///< residual of the energy balance over the energy exchanged
  double constraint_residual = 0.0; ///< m or rad, before projection
  bool is_pareto = false;           ///< no other entry is both cheaper and more accurate (Pareto-optimal)
};

/// Power law error ~ value^slope, fitted to the results of one integrator whose tolerances or steps span `decades` powers of ten.
struct ErrorSlope {
  std::string integrator;
  double slope = 0.0, decades = 0.0;
  bool is_step = false;
};

struct AccuracyStudy {
  std::vector<AccuracyEntry> entries;
  RunDifference resolution; ///< difference between the two references
  MethodSetting first_reference, second_reference;
  double budget = 0.0, spent = 0.0; ///< CPU time allowed for the list, and used by it, s

  [[nodiscard]] bool is_resolved(ErrorKind kind) const;
  /// Returns the largest error of an entry over the resolved kinds, but at least the resolution.
  [[nodiscard]] double error_of(const AccuracyEntry& entry) const;
  /// Returns the entry with the least cost whose error is at most `wanted`; null if there is none.
  [[nodiscard]] const AccuracyEntry* cheapest(double wanted) const;
  [[nodiscard]] std::vector<ErrorSlope> slopes() const;
};

inline constexpr double k_agreement = 1e-6;

/// Returns settings for all integrators in `names`: adaptive ones with tolerances 1e-3 … 1e-12, fixed-step ones with steps from 8 to 1/8
/// times `step`.
[[nodiscard]] std::vector<MethodSetting> usual_ladder(const System& system, const std::vector<std::string>& names, double step);

/// Runs the study. `base` gives the end time and the samples. Throws NumericalFailure if the two references fail or do not agree.
[[nodiscard]] AccuracyStudy study_accuracy(const System& system, const State& initial, const SimulationOptions& base,
                                           const AccuracyOptions& options);

} // namespace steplap
