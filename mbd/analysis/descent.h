// The way downhill to a pose of rest: forces give way along the constraints until they balance.
//
// Newton's method for Q + Jᵀλ = 0 on the constraint manifold: in an orthonormal basis of the motions that the rows
// allow, made orthonormal in the masses' metric, the stiffness is symmetric for all conservative forces, and its
// eigenvalues λᵢ (1/s²) and the shares gᵢ of the force give the step Σ wᵢ gᵢ/(λᵢ + σ). σ keeps it within a trust
// region and downhill where λᵢ ≤ 0; for large σ it is the way of the masses under the forces, that which a strongly
// damped machine takes. A step is projected onto the rows; it is taken as long as the work along its tangent has not
// turned against it; what projection or a contact does not let through is tried at half its length.
//
// Nothing absolute is in it: lengths are measured by the scene (its extent, and for an angle the radius at which a
// body's rows and its mass lie), forces by what rounding of poses, stiffness and reactions leaves of them.
#pragma once

#include "mbd/analysis/tangent.h"

namespace steplap {

/// Largest part of a motion: coordinate 0, 1, 2 (x, y, θ) of a body, and which way.
struct MotionPart {
  int body = 0, coordinate = 0;
  double sign = 1.0;
};

enum class DescentEnd {
  rest,     ///< forces balance, and nothing runs away at a nudge
  runs_away, ///< some body moves on without end
  no_way    ///< no step leads further, though forces do not balance
};

class Descent {
public:
  /// `state` moves: its poses, modes and friction phases. Friction that gets loaded sticks where it is then, what loses
  /// its load is let go, what slips does so until it is turned back.
  Descent(const System& system, State& state);

  DescentEnd run();

  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] double length() const { return length_; } ///< m: of the scene
  /// Per coordinate: 1 for metres, for radians one over the radius at which they are measured.
  [[nodiscard]] const VecX& scale() const { return scale_; }
  /// Largest acceleration that is left, m/s² or rad/s².
  [[nodiscard]] double residual() const { return residual_; }
  /// Multipliers of statics().rows(); of rows that depend on others one choice of many.
  [[nodiscard]] const VecX& multipliers() const { return lambda_; }
  [[nodiscard]] const Statics& statics() const { return statics_; }
  /// At rest: directions along which nothing holds it, by their largest parts.
  [[nodiscard]] const std::vector<MotionPart>& indifferent() const { return indifferent_; }
  /// Poses that balanced but that a nudge would leave, and were left.
  [[nodiscard]] const std::vector<MotionPart>& left() const { return left_; }
  /// Number of directions in which a small motion meets no resistance, where the way began and where it ended.
  [[nodiscard]] int yielding_at_start() const { return yielding_at_start_; }
  [[nodiscard]] int yielding() const { return yielding_; }
  /// What moves on without end, and the force or couple that moves it.
  [[nodiscard]] const MotionPart& runaway() const { return runaway_; }
  [[nodiscard]] double driving_force() const { return driving_force_; }

private:
  enum class Hold : unsigned char { none, sticks, slides };
  void measure_scene();
  void linearise();
  void find_modes();
  [[nodiscard]] double step_size(const VecX& step) const;
  [[nodiscard]] VecX regularised(double sigma) const;
  [[nodiscard]] VecX trust_step() const;
  [[nodiscard]] VecX newton_step() const;
  [[nodiscard]] bool is_loose(Eigen::Index i) const;
  bool move_to(const std::vector<double>& from, const VecX& step, Tangent& end);
  bool project(Tangent& end);
  bool advance(const VecX& step);
  [[nodiscard]] VecX stiff_imbalance(const Tangent& end, double& size) const;
  [[nodiscard]] double first_contact(const std::vector<double>& from, const VecX& step);
  void adapt_region(double factor, const VecX& step, bool is_straight);
  [[nodiscard]] double correct(const VecX& step, const std::vector<double>& from, double slope, Tangent& end);
  [[nodiscard]] bool loads_friction() const;
  [[nodiscard]] double first_load(const std::vector<double>& from, const VecX& step, double low, double high, Tangent& end);
  void follow_friction(const std::vector<double>& from);
  [[nodiscard]] bool has_run_away();
  [[nodiscard]] MotionPart largest_part(const VecX& scaled) const;
  bool polish();
  [[nodiscard]] int count_yielding() const;
  void finish();
  bool leave_saddle();

  const System& system_;
  State& state_;
  Statics statics_;
  int n_ = 0, iterations_ = 0, yielding_at_start_ = 0, yielding_ = 0;
  double length_ = 1.0, reach_ = 1.0; ///< of the scene, and the largest coordinate
  double radius_ = 0.0, turn_ = 0.0;  ///< trust region: m, rad
  VecX scale_;  ///< per coordinate: 1, or one over the body's radius
  VecX mass_;   ///< of the scaled coordinates
  std::vector<double> start_;
  VecX lambda_, gradient_; ///< multipliers; Q scaled
  MatX stiffness_, shape_, reduced_;   ///< scaled; w_i; −wᵀKw
  VecX value_, value_rounding_, share_, share_rounding_; ///< λᵢ, gᵢ and what is rounding of them
  double residual_ = 0.0;
  mutable double used_sigma_ = 0.0;
  std::vector<int> kept_; ///< independent rows at the last linearisation
  std::vector<Hold> hold_; ///< per friction element
  std::vector<MotionPart> indifferent_, left_;
  MotionPart runaway_;
  double driving_force_ = 0.0;
};

} // namespace steplap
