// How fast a small displacement would grow if forces and stiffness stayed what they are at one instant of a leg.
//
// Displacements δ along which the leg does not move, and which its rows and sticking friction leave free, are δ = W⁻¹ Z η: W holds the
// roots of the masses, Z is orthonormal. They follow
//   η'' = A η + B η',   A = Zᵀ W⁻¹ K W⁻¹ Z,   B = Zᵀ W⁻¹ ∂Q/∂v W⁻¹ Z,
// where K has the curvature of the rows with the reactions of that instant, inertial loads included. A displacement that grows as exp(σt)
// makes P(σ) = σ² − σ B − A singular. For symmetric A and damping B ≤ 0 the definiteness of P(σ) grows with σ: P(σ) is
// positive definite if and only if nothing grows faster than σ.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/statics.h"
#include "mbd/simulation/leg_motion.h"

namespace steplap {

/// Displacement that grows fastest.
struct FrozenGrowth {
  double rate = 0.0; ///< 1/s; 0: nothing grows as fast as was asked for
  VecX shape;        ///< W δ, of length 1; three numbers for each body but the ground; empty if nothing grows
};

/// Frozen growth along one leg.
class FrozenLeg {
public:
  /// `system`: in which the leg was made.
  FrozenLeg(const System& system, const LegMotion& leg);

  /// Directions that rows leave free at the start of the leg and in which the leg does not move.
  [[nodiscard]] Eigen::Index directions() const { return first_.cols(); }
  /// The part of W δ along these.
  [[nodiscard]] VecX along_directions(const VecX& weighted) const { return first_ * (first_.transpose() * weighted); }
  /// At the instant of `state`, if it grows faster than `least`, 1/s.
  [[nodiscard]] FrozenGrowth growth_at(const State& state, double least);

private:
  void linearise(const State& state);
  [[nodiscard]] MatX unmoved_directions() const;

  const System& system_;
  const LegMotion& leg_;
  VecX weights_;
  Dynamics dynamics_;
  Statics statics_;
  State at_run_, at_rest_; ///< in the modes of the run, and in those of statics
  VecX lambda_;            ///< multipliers of the rows of statics_
  MatX first_;             ///< Z at the start of the leg
};

} // namespace steplap
