// How fast a small displacement would grow if forces and stiffness stayed what they are at one instant of a leg.
//
// Displacements δ along which the leg does not move, and which its rows and sticking friction leave free, are δ = W⁻¹ Z η: W holds the
// roots of the masses, Z is orthonormal. They follow
//   η'' = A η + B η',   A = Zᵀ W⁻¹ K W⁻¹ Z,   B = Zᵀ W⁻¹ ∂Q/∂v W⁻¹ Z,
// where K has the curvature of the rows with the reactions of that instant, inertial loads included. A displacement that grows as exp(σt)
// makes P(σ) = σ² − σ B − A singular. For symmetric A and damping B ≤ 0 the definiteness of P(σ) grows with σ: P(σ) is
// positive definite if and only if nothing grows faster than σ. Otherwise (loads that follow, damping that drives) the eigenvalues of the
// first-order equations decide: in a leg at rest all of them, in motion the real ones, since a swing is no instant.
//
// A leg in which all bodies move evenly and do not turn has equations as constant as one at rest. There A and B are the derivatives of the
// accelerations of the whole equations of motion (linearization.h), with the terms of velocities. Rows that have a rate and no value (skates)
// hold no place: they are part of these derivatives, and Z has the directions that the other rows leave free.
//
// Stops, ropes and freewheels that touch without a force are there for displacements to one side only. Each set of them that a displacement
// leaves in touch is a *variant* with a linearisation of its own.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/statics.h"
#include "mbd/simulation/leg_motion.h"

namespace steplap {

/// Displacement that grows fastest.
struct FrozenGrowth {
  double rate = 0.0;  ///< 1/s; 0: nothing grows as fast as was asked for
  VecX shape;         ///< W δ, of length 1; three numbers for each body but the ground; empty if nothing grows
  double swing = 0.0; ///< rad/s: size of its eigenvalue if it swings while it grows, else 0
};

/// Frozen growth along one leg.
class FrozenLeg {
public:
  /// `system`: in which the leg was made.
  FrozenLeg(const System& system, const LegMotion& leg);

  /// Directions in which the leg does not move and which its rows leave free at its start: those that hold places, unless it is at rest, and
  /// that bear something, where they hold one side only.
  [[nodiscard]] Eigen::Index directions() const { return first_.cols(); }
  /// The part of W δ along these.
  [[nodiscard]] VecX along_directions(const VecX& weighted) const { return first_ * (first_.transpose() * weighted); }
  /// Some of them move this body.
  [[nodiscard]] bool moves(std::size_t body) const {
    constexpr double k_share = 1e-9; // of a direction: less is rounding
    return first_.middleRows(3 * static_cast<Eigen::Index>(body) - 3, 3).cwiseAbs().sum() > k_share;
  }
  /// All bodies move evenly, and none turns; false at rest, and where the system has inner states.
  [[nodiscard]] bool is_steady() const { return is_steady_; }
  /// Variants of what touches at the start of the leg; the first one is that of the run.
  [[nodiscard]] std::size_t variants() const { return variants_.size(); }
  /// At the instant of `state`, if it grows faster than `least`, 1/s.
  [[nodiscard]] FrozenGrowth growth_at(const State& state, double least, std::size_t variant = 0);
  /// The same by the whole equations of motion; for a steady leg.
  [[nodiscard]] FrozenGrowth steady_growth_at(const State& state, double least);

private:
  struct Variant {
    VecX displacement;      ///< δ, which tells what touches; empty: none
    bool is_let_go = false; ///< rows that hold one side and bear nothing are left out
  };
  enum class Rows : unsigned char { all, of_places };

  void linearise(const State& state, const Variant& variant);
  void take_reactions(const Snapshot& now);
  [[nodiscard]] std::vector<char> idle_one_sided_rows() const;
  [[nodiscard]] std::vector<VecX> trial_displacements() const;
  void find_variants();
  [[nodiscard]] MatX free_directions(Rows rows) const;
  [[nodiscard]] MatX moved_directions(const MatX& free) const;
  [[nodiscard]] MatX unmoved_directions(Rows rows) const;

  const System& system_;
  const LegMotion& leg_;
  VecX weights_;
  Dynamics dynamics_;
  Statics statics_;
  bool is_at_rest_, is_steady_;
  State at_run_, at_rest_; ///< in the modes of the run, and in those of statics
  std::vector<double> y_;  ///< at_run_, packed
  VecX lambda_;            ///< multipliers of the rows of statics_
  std::vector<Variant> variants_;
  const Variant* linearised_ = nullptr; ///< that of the last linearise(); null: none that is still so
  MatX first_;                          ///< Z at the start of the leg
};

} // namespace steplap
