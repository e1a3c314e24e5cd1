// A second opinion: one system run by methods that share as little as possible, and what they disagree on.
//
//   dop853, tsit5, rk4   explicit, events located on dense output
//   rodas5p              implicit, the same search for events
//   moreau               time stepping: no event is located, friction and contacts are laws of the step's end
//   auto                 what a user gets who chooses nothing
//
// Each is run at two or more settings, and its own error is estimated from them, never assumed: an adaptive
// method at a hundredth of its tolerance (the finer run's error is taken to be as large as the difference, which is
// conservative), rk4 with half its step, moreau with three steps h, h/2, h/4, whose differences d₁, d₂ give
// d₂ r/(1 − r) with the ratio r = d₂/d₁ that it really shows (1/2 where it is of first order). For fixed steps the
// estimate is not less than what passes within a step. Estimates are functions of time: the largest difference up
// to t, for every channel.
//
// Two runs disagree in a channel where they differ by more than k_margin times the sum of both estimates and a
// floor for rounding. Near events the distance is that of the two graphs, within what the event's time is uncertain by;
// reactions jump, so theirs always is, within a sample. Samples decide, so extremes over samples are compared with them. An event disagrees that
// one run has of a friction element, certain of it, and the other has not; but that a slip passes through rest and goes on another
// way is nothing that time stepping could have. Nothing is called agreed because two methods share the search
// for events: `moreau` is compared with all, and an adaptive method that knows its own answer less well than
// time stepping does is doubted for that alone.
//
// What several frictions bear along one line, feet of one body on a floor, is compared by its sum where some of them hold
// or slide against each other (audit.h, "shares"). Who bears what of it moves nothing, and is not unique: feet slide
// against each other by what the body turns, less than any velocity is known to, and with static friction above the
// kinetic one or another foot may be the one that holds. Each share has to obey the law of friction for itself.
//
// Where estimates are as large as the motion (chaos, events that hang on tiny differences) nothing can be told,
// and that is said: known_until.
//
// Three steps may show too small a change by chance, and samples leave out the side of a jump that another run's hit.
// So a run of fixed steps that disagrees is looked at again, all with a quarter of its steps and of the samples' spacing:
// what is wrong stays, and stands out by smaller estimates.
//
// Laws that a run of fixed steps breaks by its own error, which smaller steps make smaller, are no evidence against anybody. If
// they do not, that run is worth nothing, and has no opinion; of a method that locates events it is a fault all the same.
#pragma once

#include "mbd/trust/accuracy_study.h"
#include "mbd/trust/audit.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace steplap {

/// A method and the settings that it is run at, coarse to fine, each a part of the one before.
struct CrossMethod {
  std::string integrator;
  std::vector<MethodSetting> levels;
  /// The system that it runs, if not the one compared: with the same channels, and steps that end at other times.
  const System* system = nullptr;
  double longest_step = 0.0; ///< s; 0: as long as the method likes
};

struct CrossCheckOptions {
  std::vector<CrossMethod> methods; ///< empty: usual_methods()
  double cpu_limit = 60.0;          ///< s, of all runs together; each method may take an even part of what is left of it
  long evaluation_limit = std::numeric_limits<long>::max(); ///< of one run: the same on every machine
  int closer_looks = 2;                                     ///< at most, at fixed steps that disagree
  EventFilter is_event_counted;                             ///< of those of friction elements; empty: all
  /// What the run comes to, in a word; empty: not compared.
  std::function<std::string(const RunResult& run)> verdict;
  std::function<void(const MethodSetting& level, const RunResult& run)> note_level; ///< told of every run, if given
  std::vector<std::vector<int>> free_groups;                                        ///< whose momentum is looked at
  std::function<void(const std::string& text)> progress;
};

enum class Doubt { channel, event, verdict, integral, energy, momentum, law, not_a_number, self };
[[nodiscard]] const char* name_of(Doubt doubt);

struct Disagreement {
  Doubt doubt = Doubt::channel;
  std::string first, second; ///< methods; the second empty where one breaks a law alone
  std::string where;         ///< channel, element and event
  double t = 0.0;
  double ratio = 0.0; ///< difference over what the estimates allow; a disagreement above 1
  std::string text;   ///< "0.31 rad, estimates 2e-9 and 1e-4 rad"
};

struct CrossRun {
  MethodSetting setting;    ///< of the finest level, which is compared
  std::string failure;      ///< of any level; empty: all reached the end
  RunResult result;         ///< of the finest
  double cpu_seconds = 0.0; ///< of all levels
  double estimate = 0.0;    ///< own error at the end, of positions, scaled (run_comparison.h)
  double known_until = 0.0; ///< s: until there the estimate is below k_vague of the motion
  std::string verdict;
  Disagreement worst; ///< with any other, or with a law: the largest ratio
};

enum class CrossOutcome {
  agree,
  vague, ///< no disagreement, but from some time on estimates are as large as the motion
  disagree
};

struct CrossCheck {
  std::vector<CrossRun> runs;
  std::vector<Disagreement> disagreements; ///< ratio above 1, the largest first; one for each pair and doubt
  CrossOutcome outcome = CrossOutcome::agree;
  /// s, of time stepping beside the best other; 0 where its energy does not balance. Without time stepping that of the method which knows
  /// least.
  double known_until = 0.0;
  double worst_ratio = 0.0;
  int closer_looks = 0; ///< that were taken
};

/// Estimates are those of differences at single instants, and of first order near events: good to a factor of some two.
inline constexpr double k_margin = 5.0;
inline constexpr double k_vague = 0.1;

/// `step`: of the model if it has one, else 0.
[[nodiscard]] std::vector<CrossMethod> usual_methods(double end, double tolerance, double step);

/// `base` gives the end and the samples; `system` has the audit channels.
[[nodiscard]] CrossCheck cross_check(const System& system, const State& initial, const SimulationOptions& base,
                                     const CrossCheckOptions& options);

/// What the model asks for, with samples as often as a comparison needs and can bear.
[[nodiscard]] SimulationOptions sampled_for_comparison(const Model& model);

} // namespace steplap
