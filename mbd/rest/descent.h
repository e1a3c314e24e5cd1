// The way downhill to a pose of rest: forces give way along the constraints until they balance.
//
// Newton's method for Q + Jᵀλ = 0 on the constraint manifold: along the motions wᵢ that the rows allow, orthonormal in
// the masses' metric, the stiffness is symmetric for all conservative forces, and its eigenvalues λᵢ (1/s²) and the
// shares gᵢ of the force give the step Σ wᵢ gᵢ/(λᵢ + σ) (landscape.h; in large scenes without asking for each of them). σ keeps it within a trust
// region and downhill where λᵢ ≤ 0; for large σ it is the way of the masses under the forces, that which a strongly
// damped machine takes. A step is projected onto the rows; it is taken as long as the work along its tangent has not
// turned against it; what projection or a contact does not let through is tried at half its length. On its way no gap may close
// unseen (clearance.h): a thin plank is not stepped through.
//
// Nothing absolute is in it: lengths are measured by the scene (its extent, and for an angle the radius at which a
// body's rows and its mass lie), forces by what rounding of poses, stiffness and reactions leaves of them.
#pragma once

#include "mbd/rest/clearance.h"
#include "mbd/rest/landscape.h"

namespace steplap {

enum class DescentEnd {
  rest,      ///< forces balance, and nothing runs away at a nudge
  runs_away, ///< some body moves on without end
  no_way     ///< no step leads further, though forces do not balance
};

class Descent {
public:
  /// `state` moves: its poses, modes and friction phases. Friction that gets loaded sticks where it is then, what loses
  /// its load is let go, what slips does so until it is turned back.
  Descent(const System& system, State& state, RestAlgebra algebra = RestAlgebra::by_size);

  DescentEnd run();

  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] double length() const { return length_; } ///< m: of the scene
  /// Per coordinate: 1 for metres, for radians one over the radius at which they are measured.
  [[nodiscard]] const VecX& scale() const { return scale_; }
  /// Largest acceleration that is left, m/s² or rad/s².
  [[nodiscard]] double residual() const { return residual_; }
  /// Multipliers of statics().rows(); of rows that depend on others one choice of many.
  [[nodiscard]] const VecX& multipliers() const { return landscape_->multipliers(); }
  [[nodiscard]] const Statics& statics() const { return statics_; }
  /// At rest: directions along which nothing holds it, by their largest parts.
  [[nodiscard]] const std::vector<MotionPart>& indifferent() const { return indifferent_; }
  [[nodiscard]] int more_indifferent() const { return more_indifferent_; } ///< directions beside those
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
  [[nodiscard]] double step_size(const VecX& step) const;
  bool move_to(const std::vector<double>& from, const VecX& step);
  bool project();
  bool advance(VecX step);
  [[nodiscard]] int looks_along(const VecX& step) const;
  bool land(const std::vector<double>& from, VecX& step);
  [[nodiscard]] double slope_along(const VecX& step) const;
  [[nodiscard]] double first_contact(const std::vector<double>& from, const VecX& step);
  void look_on(const std::vector<double>& from, const VecX& step, double before, double& share);
  [[nodiscard]] VecX way_from(const std::vector<double>& from) const;
  void adapt_region(double factor, const VecX& step, bool is_straight);
  [[nodiscard]] double correct(const VecX& step, const std::vector<double>& from, double slope);
  [[nodiscard]] bool loads_friction() const;
  [[nodiscard]] double first_load(const std::vector<double>& from, const VecX& step, double low, double high);
  void follow_friction(const std::vector<double>& from);
  void find_dependent_friction();
  [[nodiscard]] bool has_run_away();
  bool polish();
  void finish();
  bool leave_saddle();

  const System& system_;
  State& state_;
  Statics statics_;
  int n_ = 0, iterations_ = 0, yielding_at_start_ = 0, yielding_ = 0, more_indifferent_ = 0;
  bool is_sparse_ = false;
  double length_ = 1.0, reach_ = 1.0; ///< of the scene, and the largest coordinate
  double radius_ = 0.0, turn_ = 0.0;  ///< trust region: m, rad
  VecX scale_;                        ///< per coordinate: 1, or one over the body's radius
  VecX mass_;                         ///< of the scaled coordinates
  std::unique_ptr<Landscape> landscape_;
  std::unique_ptr<Clearance> clearance_;
  std::vector<double> start_;
  double residual_ = 0.0;
  std::vector<Hold> hold_;     ///< per friction element
  std::vector<char> left_out_; ///< per row of friction: it depends on others that hold, and is not asked for
  std::vector<MotionPart> indifferent_, left_;
  MotionPart runaway_;
  double driving_force_ = 0.0;
};

} // namespace steplap
