// Event location: finds the first event inside a step that an integrator has made.
//
// The elements provide event functions g_i(t), in the code `event_value`, one per slot. A mode is valid while its event functions
// are ≥ 0 (roles.h). An event is a change of some g_i from ≥ 0 to < 0. Position in the step is θ = (t − t0)/h, 0 ≤ θ ≤ 1.
//
// Sign changes at the ends of the step are not sufficient: g_i can be negative between two positive ends. A step is therefore
// accepted without event only if every g_i is shown to be positive on all of it. Three tests are applied in turn, from cheap to
// expensive (docs/explanation/theory.md, "Events"):
//   1. far      (event_finder.cpp) The least value at ends and stages exceeds half the largest.
//   2. certain  (event_nodes.h)    The chord between neighbouring samples, less a bound ½ M (x − x_j)(x_{j+1} − x) with M ≥ |g″|,
//                                  is positive.
//   3. survey   (event_survey.cpp) g_i is interpolated on the dense output by polynomials with an error bound. The step is
//                                  subdivided until each part is shown to be positive or contains a sign change.
// A sign change gives a bracket. The root in it is located to rounding (event_closing.cpp). All functions that are negative at the
// end of the final bracket fire together.
//
// An event function is armed if a negative value counts as an event. A function is fresh if its element has just changed mode: it
// starts at zero with an error of either sign, so it is armed only after it has been positive once.
//
// If the survey needs more parts than allowed, the step ends where the search has arrived, without an event.
#pragma once

#include "mbd/base/part_polynomial.h"
#include "mbd/base/root_estimate.h"
#include "mbd/integrators/integrator.h"

#include <array>
#include <limits>
#include <vector>

namespace steplap {

class EventFinder {
public:
  /// `max_dimension`: largest dimension of the packed state in any mode. Keeps a reference to `system`.
  EventFinder(const System& system, int max_dimension);

  /// Searches the step that `integrator` has just made. `dynamics` must be in the modes of that step. `fresh` has one flag per slot
  /// (EventHandler::fresh()). Returns true if the step has to end early, or at an event; theta(), state() and fired() are valid
  /// until the next call. fired() is empty if the step only has to end early. Evaluates `dynamics` on the dense output.
  bool find(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);

  /// True if the last find() returned false because the integrator has withdrawn the step: its dense output was not accurate enough
  /// to be searched. The caller must make the step again.
  [[nodiscard]] bool is_step_withdrawn() const { return is_step_withdrawn_; }

  [[nodiscard]] double theta() const { return theta_; }                  ///< θ at which the step ends
  [[nodiscard]] const std::vector<double>& state() const { return y_; }  ///< packed state at theta(), from dense output, not projected
  [[nodiscard]] const std::vector<int>& fired() const { return fired_; } ///< slots that have become negative, ascending

private:
  /// Result of tests 1 and 2. none: no event. at_end: only functions with one simple root, negative at the end of the step.
  /// inside: some function has to be surveyed.
  enum class Screening { none, at_end, inside };
  /// found: low_ and high_ enclose the root. immediate: the event is at high_.theta, without root finding.
  enum class Bracket { none, found, immediate };
  /// Sample of all event functions.
  struct Sample {
    double theta = 0.0;
    std::vector<double> event_value, rate; ///< g_i and dg_i/dθ; the derivative is NaN if the element does not provide it
  };
  /// Interval of the step that is to be surveyed. `slot`, `error` and `stalled` describe the function that caused the last split.
  struct Interval {
    double begin = 0.0, end = 1.0;
    int slot = -1;
    double error = 0.0; ///< its interpolation error on the parent interval
    int stalled = 0;    ///< number of successive splits that did not reduce this error
  };
  /// Reason to split a part: function `slot` may be negative near `position`.
  struct Split {
    double position = -1.0; ///< relative position in the interval, 0 … 1; −1: no reason
    int slot = -1;
    double error = 0.0;
    int stalled = 0;
  };
  /// Interpolant of one event function on the present interval.
  struct Interpolant {
    int slot = -1;
    int stalled = 0;
    std::size_t from = 0, to = 0; ///< nodes between which the function has to be positive
    bool has_fired = false;       ///< the function is negative at node to + 1
    PartPolynomial polynomial;
  };

  /// Applies tests 1 and 2; fills surveyed_slots_ with the slots that pass neither.
  [[nodiscard]] Screening screen(Integrator& integrator, const Dynamics& dynamics, const std::vector<char>& fresh);
  [[nodiscard]] bool is_merged(const Dynamics& dynamics, int slot);
  /// Uses the whole step as the bracket; for Screening::at_end.
  Bracket bracket_whole(const Integrator& integrator);
  // --- event_survey.cpp
  Bracket survey(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);
  bool survey_interval(Integrator& integrator, Dynamics& dynamics, const Interval& interval);
  void push_first_interval(Integrator& integrator, Dynamics& dynamics, bool is_any_unarmed);
  void arm_positive(double theta, const std::vector<double>& event_value);
  std::size_t sample_nodes(Integrator& integrator, Dynamics& dynamics, const Interval& interval);
  void fit_interpolants(const Interval& interval, std::size_t last);
  [[nodiscard]] double tangent_intersection(int slot, std::size_t last) const;
  [[nodiscard]] int first_uncertain_gap(const Interpolant& interpolant) const;
  [[nodiscard]] Split split_at(const Interpolant& interpolant, double position) const;
  [[nodiscard]] Split find_split(std::size_t last) const;
  [[nodiscard]] double check_point() const;
  [[nodiscard]] Split verify_interpolants(Integrator& integrator, Dynamics& dynamics, const Interval& interval, std::size_t last);
  // --- event_closing.cpp
  void locate_root(Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] double next_estimate(double middle);
  [[nodiscard]] double secant_estimate() const;
  [[nodiscard]] bool is_root_just_before(const Sample& beyond, double half_width) const;

  /// Evaluates all event functions at `theta` on the dense output.
  void sample_at(Integrator& integrator, Dynamics& dynamics, double theta, Sample& sample);
  /// Takes the event functions that the integrator has stored at the start or the end (`is_last`) of the step.
  static void stored_sample(const Integrator& integrator, bool is_last, Sample& sample);
  /// Puts the armed slots with low ≥ 0 and high < 0 into fired_. Returns true if there are any.
  [[nodiscard]] bool find_sign_changes(const Sample& low, const Sample& high);
  /// As find_sign_changes(), but with the tolerance tolerance_ instead of zero, and with zero for `high` at the end of the step. A step
  /// therefore never ends with a negative value, and an excursion within the tolerance is neither lost nor reported twice.
  [[nodiscard]] bool find_sign_changes_beyond_tolerance(const Sample& low, const Sample& high);
  [[nodiscard]] Bracket classify_bracket();
  [[nodiscard]] bool is_any_merged_near(const Integrator& integrator, const Dynamics& dynamics) const;
  void set_tolerance(const Integrator& integrator, const Dynamics& dynamics);

  const System& system_;
  int slots_;
  double theta_ = 0.0;
  bool is_step_withdrawn_ = false;
  std::vector<double> y_, dy_;
  Sample low_, high_, middle_; ///< ends of the bracket and a sample inside
  static constexpr std::size_t k_history = 7;
  std::array<Sample, k_history> history_; ///< last samples, in a ring; the root is estimated from them
  std::size_t history_count_ = 0;
  RootEstimate estimate_;
  /// State of the root iteration, in units of θ.
  struct RootIteration {
    double half_width = 0.0;   ///< half-width of the final bracket around the root
    double root = 0.0;         ///< last estimate
    double distance = 1.0;     ///< difference of the last two estimates
    double expected = 1.0;     ///< predicted error of the last estimate
    int count = 0;             ///< number of estimates
    bool is_converged = false; ///< the estimate is as accurate as rounding allows
  };
  RootIteration iteration_;
  static constexpr std::size_t k_node_count = PartPolynomial::k_order + 1;
  std::array<Sample, k_node_count> nodes_; ///< samples at the interpolation nodes of the present interval
  /// Tolerance below zero, per slot. A dip that is no deeper and recovers within the step is no event. Accuracy of velocities for
  /// slip rates, as given by ForceGroup::event_tolerance() for units, zero for all others.
  std::vector<double> tolerance_;
  std::vector<int> place_slots_, rate_slots_; ///< slots with EventTolerance::position; slots with EventTolerance::velocity
  std::vector<char> is_of_joint_;             ///< per slot: belongs to friction of dimension 3 (step-lap joint)
  std::vector<int> surveyed_slots_;           ///< slots to be surveyed
  std::vector<char> merged_;                  ///< per slot: belongs to a joint inside a cluster; computed at the first use in a step
  bool are_merged_known_ = false;             ///< merged_ is valid for this step
  std::vector<Interpolant> interpolants_;     ///< interpolants of the functions in surveyed_slots_ on the present part
  std::vector<Interval> intervals_;           ///< stack of parts still to be surveyed; the earliest is on top
  bool is_merged_near_ = false;               ///< a joint inside a cluster may slip in this step, so every sample evaluates such joints
  std::vector<char> armed_, armed_before_;    ///< per slot: armed; value at the start of the present interval
  std::vector<int> fired_, fired_before_;
};

} // namespace steplap
