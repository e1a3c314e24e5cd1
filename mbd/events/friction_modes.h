// Which frictional elements stick and which begin to slip, decided for all of them together.
//
// At zero relative velocity the accelerations minimise Gauss' function plus the support functions
// of the admissible sets (physics.md §3). Its dual is solved here: wrenches w in ΠK_e that minimise
// ½ wᵀA w + bᵀw, with A the constrained compliance of the candidates' rows and b their relative
// acceleration without friction; A w + b is then the relative acceleration, zero for those that
// stick. Elements whose sticking wrench turns out admissible never enter the problem.
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

class FrictionModes {
public:
  FrictionModes(const System& system, Dynamics& dynamics);

  /// Decides the phases of all elements that stick or are at rest (phase stick) in `state`, at its
  /// pose and velocity; those in phase slip stay so. Leaves `dynamics` on the layout of the result.
  /// Throws NumericalFailure if the problem cannot be solved. True if all of them hold as they are.
  bool decide(State& state);

  /// `dynamics` in the modes and at the pose and velocity of `state`, with all watch values.
  void evaluate(const State& state);
  /// The state has changed since, or `dynamics` was used for something else.
  void forget_evaluation() { is_evaluated_ = false; }
  /// What is known of the present state: it was evaluated last, and nothing has moved or changed its mode since.
  [[nodiscard]] bool is_evaluated() const { return is_evaluated_; }
  /// Of the last evaluate(): the packed state and its rates.
  [[nodiscard]] const double* packed() const { return y_.data(); }
  [[nodiscard]] const double* rates() const { return dy_.data(); }

  /// Lets go those of a group (LoadSharing) that slip when it gives way; `dynamics` was last asked for its watch
  /// values at `state`.
  void release(State& state, int group) const;

  /// Element f came to rest with `rate` at this event: what the instant and the motion are known to.
  void note_rest(int f, double rate) { rest_error_[f] = std::abs(rate); }
  void begin_event() { std::fill(rest_error_.begin(), rest_error_.end(), 0.0); }

  /// Elements in phase slip that are at rest, since others which stick hold them, share in bearing the load: they
  /// stick, if the group they make can bear it. True if any does.
  bool rejoin(State& state);

  /// Elements of one dimension in phase slip that have come to rest and would turn round, as they do at the very instant
  /// at which another, geared to them, does: they become candidates (phase stick). `was_slipping`: per element, before
  /// the event: what begins to slip now is at rest, too. True if there are any.
  bool catch_reversals(State& state, const std::vector<FrictionState>& before);

  /// Anchors the rows of element f at the present pose.
  void set_anchor(State& state, int f) const;
  /// The same where a slip has ended: the path slid since the last anchor counts.
  void end_slip(State& state, int f) const;

private:
  [[nodiscard]] std::vector<int> violated(const State& state);
  [[nodiscard]] std::vector<int> held_beyond(const State& state) const;
  void solve(State& state, const std::vector<int>& candidates);
  void anchor_resting(State& state) const;
  void let_go_moving(State& state);
  void settle_candidates(State& state, std::vector<int> candidates);
  [[nodiscard]] bool release_overloaded(State& state) const;
  [[nodiscard]] bool is_at_rest(const State& state, int f) const;
  [[nodiscard]] double rest_error(int f) const;

  const System& system_;
  Dynamics& dynamics_;
  std::vector<double> y_, dy_;
  bool is_evaluated_ = false;
  std::vector<double> rest_error_;             ///< per element: of its rate, m/s, as it came to rest at the present event
  mutable std::vector<Motion<double>> motion_; ///< of the bodies at an anchor: scratch
};

} // namespace steplap
