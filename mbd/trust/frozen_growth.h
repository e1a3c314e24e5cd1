// Growth rate of small displacements if forces and stiffness stayed constant at one instant of a leg (a part of a run in which the same
// elements are active).
//
// Displacements δ are considered along which nothing moves in the leg, and which constraint rows and sticking friction leave free: δ = W⁻¹
// Z η, with W the square roots of the masses and Z orthonormal. They satisfy
//   η'' = A η + B η',   A = Zᵀ W⁻¹ K W⁻¹ Z,   B = Zᵀ W⁻¹ ∂Q/∂v W⁻¹ Z,
// where K contains the curvature of the rows with the reactions of that instant, which include inertial loads. If a displacement grows as
// exp(σt), P(σ) = σ² − σ B − A is singular. For symmetric A and damping B ≤ 0, P(σ) is positive definite if and only if nothing grows
// faster than σ. Otherwise (follower loads, negative damping) the eigenvalues of the first-order equations are computed. In a leg at rest
// all eigenvalues count; in motion only real ones, because an oscillation takes longer than the instant.
//
// If all bodies move at constant velocity without rotation, the equations are as constant as at rest. Then A and B are the derivatives of
// the accelerations in the full equations of motion (linearization.h), with their velocity terms. Rows on velocities only (skates) do not
// hold a position: they are part of these derivatives, and Z contains the directions that the other rows leave free.
//
// Stops, ropes and freewheels that touch without force resist displacements to one side only. Each set of them that stays in touch under
// some displacement is a *variant* with its own linearisation.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/statics.h"
#include "mbd/simulation/leg_motion.h"

namespace steplap {

/// The displacement that grows fastest.
struct FrozenGrowth {
  double rate = 0.0;  ///< growth rate, 1/s; 0 if nothing grows faster than the requested rate
  VecX shape;         ///< W δ normalised to length 1, three numbers for each body except the ground; empty if nothing grows
  double swing = 0.0; ///< imaginary part of the eigenvalue if the displacement oscillates while it grows, rad/s; else 0
};

/// Growth rates of small displacements, frozen at instants of one leg.
class FrozenLeg {
public:
  /// `system` is the system of the leg. Keeps references to both arguments.
  FrozenLeg(const System& system, const LegMotion& leg);

  /// Returns the number of directions in which nothing moves in the leg and which the rows leave free at its start. Rows on velocities
  /// count in a leg at rest only. One-sided rows count if they carry force.
  [[nodiscard]] Eigen::Index directions() const { return first_.cols(); }
  /// Returns the component of W δ along the directions that directions() counts.
  [[nodiscard]] VecX along_directions(const VecX& weighted) const { return first_ * (first_.transpose() * weighted); }
  /// Returns true if a displacement along one of the directions that directions() counts moves the body.
  [[nodiscard]] bool moves(std::size_t body) const {
    constexpr double k_share = 1e-9; // part of a direction of length 1; less is rounding
    return first_.middleRows(3 * static_cast<Eigen::Index>(body) - 3, 3).cwiseAbs().sum() > k_share;
  }
  /// Returns true if all bodies move at constant velocity and none rotates; false at rest, and for systems with inner states.
  [[nodiscard]] bool is_steady() const { return is_steady_; }
  /// Returns the number of variants (sets of one-sided contacts in touch) at the start of the leg. Variant 0 is that of the run.
  [[nodiscard]] std::size_t variants() const { return variants_.size(); }
  /// Returns the fastest growth with the forces and stiffness at `state`; empty if its rate does not exceed `least`, 1/s.
  [[nodiscard]] FrozenGrowth growth_at(const State& state, double least, std::size_t variant = 0);
  /// Returns the fastest growth by the full equations of motion. Precondition: is_steady().
  [[nodiscard]] FrozenGrowth steady_growth_at(const State& state, double least);

private:
  struct Variant {
    VecX displacement;      ///< displacement that determines which one-sided rows are in touch; empty: none
    bool is_let_go = false; ///< one-sided rows without force are left out
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
  State at_run_, at_rest_; ///< the state with the modes of the run, and with those of statics
  std::vector<double> y_;  ///< at_run_ as a packed vector
  VecX lambda_;            ///< multipliers of the rows of statics_
  std::vector<Variant> variants_;
  const Variant* linearised_ = nullptr; ///< variant of the last linearise(); null if none is valid
  MatX first_;                          ///< Z at the start of the leg
};

} // namespace steplap
