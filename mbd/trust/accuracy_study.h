// What a result costs: integrators over a ladder of tolerances and steps, each against a reference.
//
// The reference comes from two independent methods at tight tolerance. What they differ by is the
// resolution: an entry's error below it is not known, only that it is not larger. A kind of error
// (positions, velocities, reactions, event times) on which the two differ by more than k_agreement
// is not spoken of at all; if they differ so in the positions, there is no reference, and nothing
// is said.
//
// The ladder is climbed within a budget of CPU time, always where the next rung costs least, as far as the rungs below tell:
// what a budget leaves out are the dearest settings, and the table says so.
//
// Cost is the CPU time of one thread without samples, the least of several runs; the error is taken
// from a further run with samples, which takes the same steps: output never forces one.
#pragma once

#include "mbd/trust/run_comparison.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// An integrator with a tolerance, or with a step where it does not choose its own.
struct MethodSetting {
  std::string integrator;
  double value = 0.0;
  bool is_step = false; ///< value is a step, s

  /// "dop853 1e-08", "rk4 h = 0.0001 s"
  [[nodiscard]] std::string text() const;
  [[nodiscard]] SimulationOptions applied_to(SimulationOptions options) const;
};

struct AccuracyOptions {
  std::vector<MethodSetting> ladder;
  MethodSetting first_reference{"dop853", 1e-13}, second_reference{"tsit5", 1e-13};
  int repeats = 3;                                         ///< at most: of runs that take a large part of the budget fewer
  double cpu_limit = 60.0;                                 ///< s: a run that needs more is given up, and the table says so
  double budget = std::numeric_limits<double>::infinity(); ///< s of CPU time for the ladder; the references come first and are not counted
  EventFilter is_event_counted;                            ///< empty: all events
  std::function<void(const std::string& text)> progress;   ///< what is being run, if given
};

struct AccuracyEntry {
  MethodSetting setting;
  std::string failure;      ///< why there is no result; empty: there is one
  bool is_left_out = false; ///< it would have gone beyond the budget
  double cpu_seconds = 0.0;
  RunStatistics cost; ///< of a run without samples
  RunDifference error;
  double energy_residual = 0.0;     ///< of the energy exchanged
  double constraint_residual = 0.0; ///< m or rad, before projection
  bool is_pareto = false;           ///< no other entry is both cheaper and more accurate
};

/// How errors follow the tolerance, or the step: error ~ value^slope, over `decades` of value.
struct ErrorSlope {
  std::string integrator;
  double slope = 0.0, decades = 0.0;
  bool is_step = false;
};

struct AccuracyStudy {
  std::vector<AccuracyEntry> entries;
  RunDifference resolution; ///< between the two references
  MethodSetting first_reference, second_reference;
  double budget = 0.0, spent = 0.0; ///< s of CPU time, on the ladder

  [[nodiscard]] bool is_resolved(ErrorKind kind) const;
  /// The largest error of an entry among the kinds that are resolved, not less than the resolution.
  [[nodiscard]] double error_of(const AccuracyEntry& entry) const;
  /// The entry with the least cost whose error is at most `wanted`; null if there is none.
  [[nodiscard]] const AccuracyEntry* cheapest(double wanted) const;
  [[nodiscard]] std::vector<ErrorSlope> slopes() const;
};

inline constexpr double k_agreement = 1e-6;

/// All integrators that `names` lists, adaptive ones with tolerances 1e-3 … 1e-12, fixed-step ones
/// with steps from 8 to 1/8 of `step`.
[[nodiscard]] std::vector<MethodSetting> usual_ladder(const System& system, const std::vector<std::string>& names, double step);

/// `base` gives the end and the samples. Throws NumericalFailure if the two references cannot be
/// had or do not agree.
[[nodiscard]] AccuracyStudy study_accuracy(const System& system, const State& initial, const SimulationOptions& base,
                                           const AccuracyOptions& options);

} // namespace steplap
