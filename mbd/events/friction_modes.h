// Decides which friction elements stick and which begin to slip, for all of them together.
//
// At zero relative velocity the accelerations minimise Gauss' function plus the support functions of the admissible sets (theory.md §3).
// This class solves the dual problem: find wrenches w in ΠK_e that minimise ½ wᵀA w + bᵀw, with A the constrained compliance of the
// candidates' rows and b their relative acceleration without friction. A w + b is the relative acceleration with friction, zero for
// elements that stick. Candidates are the elements whose sticking wrench is not admissible, and those that they affect.
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

/// Decides the phases of the friction elements of one system.
class FrictionModes {
public:
  FrictionModes(const System& system, Dynamics& dynamics);

  /// Decides the phases of all elements in phase stick at the pose and velocity of `state`; elements in phase slip are unchanged. Leaves
  /// `dynamics` in the layout of the result. Returns true if all of them still stick. Throws NumericalFailure if the problem cannot be
  /// solved.
  bool decide(State& state);

  /// Evaluates `dynamics` in the modes and at the pose and velocity of `state`, with all event functions.
  void evaluate(const State& state);
  /// Marks the evaluation as invalid. To be called when the state changes or `dynamics` is used otherwise.
  void forget_evaluation() { is_evaluated_ = false; }
  /// Returns true if the last evaluation belongs to the present state and modes.
  [[nodiscard]] bool is_evaluated() const { return is_evaluated_; }
  /// Return the packed state and its rates of the last evaluate().
  [[nodiscard]] const double* packed() const { return y_.data(); }
  [[nodiscard]] const double* rates() const { return dy_.data(); }

  /// Sets the elements of an overloaded group (LoadSharing) to slip that slide according to limit analysis. Precondition: `dynamics` was
  /// last evaluated at `state`.
  void release(State& state, int group) const;

  /// Records that element f came to rest at this event with the residual rate `rate`, which is the error of the event time and of the
  /// velocities.
  void note_rest(int f, double rate) { rest_error_[f] = std::abs(rate); }
  void begin_event() { std::fill(rest_error_.begin(), rest_error_.end(), 0.0); }

  /// Sets elements in phase slip to stick if they are at rest because others hold them, and if their group can carry the load. Returns true
  /// if there are any.
  bool rejoin(State& state);

  /// Finds one-dimensional elements in phase slip that have come to rest and would reverse, as geared elements do at the same instant. Sets
  /// them to phase stick, so that they become candidates. `before`: states before the event, which exclude elements at rest because they
  /// begin to slip now. Returns true if there are any.
  bool catch_reversals(State& state, const std::vector<FrictionState>& before);

  /// Anchors the rows of element f at the present pose.
  void set_anchor(State& state, int f) const;
  /// Anchors the rows of element f at the end of a slip and adds the distance since the last anchor to the slid path.
  void end_slip(State& state, int f) const;

private:
  [[nodiscard]] std::vector<int> violated(const State& state);
  [[nodiscard]] std::vector<int> sticking_beyond_bound(const State& state) const;
  void solve(State& state, const std::vector<int>& candidates);
  void anchor_resting(State& state) const;
  void release_moving(State& state);
  void settle_candidates(State& state, std::vector<int> candidates);
  [[nodiscard]] bool release_overloaded(State& state) const;
  [[nodiscard]] bool is_at_rest(const State& state, int f) const;
  [[nodiscard]] double rest_error(int f) const;

  const System& system_;
  Dynamics& dynamics_;
  std::vector<double> y_, dy_;
  bool is_evaluated_ = false;
  std::vector<double> rest_error_;             ///< per element: residual rate when it came to rest at the present event, m/s
  mutable std::vector<Motion<double>> motion_; ///< scratch: motions of the bodies
};

} // namespace steplap
