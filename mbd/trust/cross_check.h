// Cross check: one system is run by methods that have little in common, and the differences between their results are judged.
//
//   dop853, tsit5, rk4   explicit, events located on dense output
//   rodas5p              implicit, the same search for events
//   moreau               time stepping: no event is located, friction and contacts are laws at the end of a step
//   auto                 default choice of a user
//
// Each method is run at two or more settings, from which its own error is estimated. For an adaptive method the second run has a hundredth
// of the tolerance; the error of the finer run is taken as the whole difference, which is conservative. rk4 is repeated with half its step.
// moreau is run with h, h/2 and h/4: the differences d₁, d₂ give the error d₂ r/(1 − r) with r = d₂/d₁ as observed (1/2 for first order).
// For fixed steps the estimate is at least the motion within one step. An estimate is a function of time for every channel: the largest
// difference up to t.
//
// Two runs disagree in a channel if they differ by more than k_margin (sum of both estimates + floor for rounding). Near events the
// distance between the two graphs is used, within the uncertainty of the event's time. For reactions, which jump, it is used everywhere,
// within one sample. Only samples are compared, so extremes over samples are used too. A friction event that is certain in one run and
// missing in the other is a disagreement, except a slip that passes through rest and continues in another direction: time stepping cannot
// show it. Two methods with the same search for events do not confirm each other: `moreau` is compared with all. An adaptive method whose
// own error is larger than that of time stepping is reported for that alone.
//
// If several friction elements act along one line (feet of one body on a floor) and some of them stick or slide against each other, only
// the sum of their forces is compared (audit.h, "shares"). The split does not affect the motion and is not unique: the feet slide against
// each other by the rotation of the body, which is less than the accuracy of any velocity, and with μ_s > μ_k either foot may be the one
// that sticks. Each force must still obey the law of friction.
//
// If estimates become as large as the motion (chaos, events that depend on tiny differences), no comparison is possible from then on;
// `known_until` reports that time.
//
// Three steps may agree by chance, and samples may miss one side of a jump. So if a run with fixed steps disagrees, all are repeated with a
// quarter of the steps and of the sample spacing. A real fault remains and stands out more clearly.
//
// If a run with fixed steps violates a law and smaller steps reduce the violation, this is its discretisation error and counts against no
// method. If smaller steps do not help, that run is discarded. For a method that locates events the violation is a fault in any case.
#pragma once

#include "mbd/trust/accuracy_study.h"
#include "mbd/trust/audit.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace steplap {

/// A method with the settings at which it is run, from coarse to fine. Each tolerance or step is a fraction of the one before.
struct CrossMethod {
  std::string integrator;
  std::vector<MethodSetting> levels;
  /// System to run instead of the compared one; null: the same. It must have the same channels, but its steps end at other times.
  const System* system = nullptr;
  double longest_step = 0.0; ///< longest step, s; 0: no limit
};

struct CrossCheckOptions {
  std::vector<CrossMethod> methods; ///< empty: usual_methods()
  double cpu_limit = 60.0;          ///< CPU time of all runs together, s; each method may use an equal part of what is left
  long evaluation_limit = std::numeric_limits<long>::max(); ///< most evaluations in one run; unlike CPU time not dependent on the computer
  int refinements = 2;                                      ///< largest number of repetitions with smaller fixed steps after a disagreement
  EventFilter is_event_counted;                             ///< selects friction events to compare; empty: all
  /// Returns the verdict on a run as one word, to be compared between methods. If empty, verdicts are not compared.
  std::function<std::string(const RunResult& run)> verdict;
  std::function<void(const MethodSetting& level, const RunResult& run)> note_level; ///< called after every run, if set
  std::vector<std::vector<int>> free_groups;                                        ///< groups whose momentum is checked
  std::function<void(const std::string& text)> progress;
};

enum class DisagreementKind { channel, event, verdict, integral, energy, momentum, law, not_a_number, self };
[[nodiscard]] const char* name_of(DisagreementKind doubt);

struct Disagreement {
  DisagreementKind doubt = DisagreementKind::channel;
  std::string first, second; ///< methods; `second` is empty if the first alone violates a law
  std::string where;         ///< channel, or element and event
  double t = 0.0;
  double ratio = 0.0; ///< difference over the largest one that the estimates allow; above 1 the runs disagree
  std::string text;   ///< values as text: "0.31 rad, estimates 2e-9 and 1e-4 rad"
};

struct CrossRun {
  MethodSetting setting;    ///< finest setting, whose result is compared
  std::string failure;      ///< reason why a run of any setting failed; empty: all reached the end
  RunResult result;         ///< result of the finest setting
  double cpu_seconds = 0.0; ///< CPU time of all settings, s
  double estimate = 0.0;    ///< own error of positions at the end, scaled as in run_comparison.h
  double known_until = 0.0; ///< time until which the estimated error of positions is below k_vague of the motion, s
  std::string verdict;
  Disagreement worst; ///< the disagreement with the largest ratio, with another method or with a law
};

enum class CrossOutcome {
  agree,
  vague, ///< no disagreement, but at some time the errors become as large as the motion
  disagree
};

struct CrossCheck {
  std::vector<CrossRun> runs;
  std::vector<Disagreement> disagreements; ///< ratio > 1, the largest first; one per pair of methods and per fault of one method
  CrossOutcome outcome = CrossOutcome::agree;
  /// Time until which the result is known, s: the smaller of the times of time stepping and of the best other method; 0 if the energy of
  /// time stepping does not balance. Without time stepping it is the time of the least accurate method.
  double known_until = 0.0;
  double worst_ratio = 0.0;
  int refinements = 0; ///< number of repetitions made
};

/// Safety factor on error estimates. Estimates are differences at single instants, of first order near events, and reliable to a factor of
/// about two.
inline constexpr double k_margin = 5.0;
inline constexpr double k_vague = 0.1;

/// Returns the methods with their settings. `step`: step of the model, 0 if it has none.
[[nodiscard]] std::vector<CrossMethod> usual_methods(double end, double tolerance, double step);

/// Runs the cross check. `base` gives the end time and the samples. Precondition: `system` has the audit channels.
[[nodiscard]] CrossCheck cross_check(const System& system, const State& initial, const SimulationOptions& base,
                                     const CrossCheckOptions& options);

/// Returns the options of the model with as many samples as a comparison needs.
[[nodiscard]] SimulationOptions sampled_for_comparison(const Model& model);

} // namespace steplap
