// Which frictional elements stick and which begin to slip, decided for all of them together.
//
// At zero relative velocity the accelerations minimise Gauss' function plus the support functions
// of the admissible sets (physics.md §3). Its dual is solved here: wrenches w in ΠK_e that minimise
// ½ wᵀA w + bᵀw, with A the constrained compliance of the candidates' rows and b their relative
// acceleration without friction; A w + b is then the relative acceleration, zero for those that
// stick. Elements whose sticking wrench turns out admissible never enter the problem.
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <vector>

namespace steplap {

class FrictionModes {
public:
  FrictionModes(const System& system, Dynamics& dynamics);

  /// Decides the phases of all elements that stick or are at rest (phase stick) in `state`, at its
  /// pose and velocity; those in phase slip stay so. Leaves `dynamics` on the layout of the result.
  /// Throws NumericalFailure if the problem cannot be solved.
  void decide(State& state);

  /// Lets go those of a group (LoadSharing) that slip when it gives way; `dynamics` was last asked for its watch
  /// values at `state`.
  void release(State& state, int group) const;

  /// Elements in phase slip that are at rest, since others which stick hold them, share in bearing the load: they
  /// stick, if the group they make can bear it.
  void rejoin(State& state);

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
  void solve(State& state, const std::vector<int>& candidates);
  void anchor_resting(State& state) const;
  void let_go_moving(State& state);
  void settle_candidates(State& state, std::vector<int> candidates);
  [[nodiscard]] bool release_overloaded(State& state) const;
  [[nodiscard]] bool is_at_rest(const State& state, int f) const;

  const System& system_;
  Dynamics& dynamics_;
  std::vector<double> y_, dy_;
};

} // namespace steplap
