// Descent to static equilibrium: bodies are moved along the constraints, downhill in potential energy, until forces balance.
//
// Newton's method for Q + Jᵀλ = 0 on the constraint manifold. Let wᵢ be the motions that the rows allow, orthonormal in the mass metric.
// For conservative forces the stiffness along them is symmetric; its eigenvalues λᵢ (1/s²) and the components gᵢ of the force give the step
// Σ wᵢ gᵢ/(λᵢ + σ) (landscape.h; in large models the λᵢ are not computed). The shift σ keeps the step within a trust region, and downhill
// if some λᵢ ≤ 0. For large σ the step follows the accelerations, as in a strongly damped machine. A step is projected onto the rows. It is
// accepted unless the forces at its end oppose it by more than half of their drive at its start. It is halved if it is not accepted, if the
// projection fails, or if a contact stops it. No gap may close unnoticed along the step (clearance.h), so that bodies do not pass through
// thin planks.
//
// All tolerances are relative: those of lengths to the size of the model (its extent; for an angle, the radius at which rows and mass of
// the body lie), those of forces to the rounding errors of poses, stiffness and reactions.
#pragma once

#include "mbd/rest/clearance.h"
#include "mbd/rest/landscape.h"

#include <numbers>

namespace steplap {

enum class DescentEnd {
  rest,      ///< forces balance in a stable equilibrium
  runs_away, ///< a body moves without end
  no_way     ///< forces do not balance, but no step makes progress
};

class Descent {
public:
  /// Changes poses, modes and friction phases of `state`. A friction element that gains normal force sticks at that pose, one that loses it
  /// is released, and one that slips continues until its motion reverses. Friction along a line that changes its contact point holds
  /// the pose of its first touch, unless its bodies have moved far from there.
  Descent(const System& system, State& state, RestAlgebra algebra = RestAlgebra::by_size);

  DescentEnd run();
  /// For a small change of the loads: a body that moves further than `reach`, in sizes of the model and rad, counts as moving without end, and
  /// friction that slides keeps its direction, whatever the search passes through. The search ends after fewer iterations.
  void follow_increment(double reach);

  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] double length() const { return length_; } ///< size of the model, m
  /// Returns the displacement per scaled coordinate: 1 for lengths; for angles the reciprocal of the radius at which rows and mass of the
  /// body lie.
  [[nodiscard]] const VecX& scale() const { return scale_; }
  /// Returns the largest remaining acceleration, m/s² or rad/s².
  [[nodiscard]] double residual() const { return residual_; }
  /// Returns the multipliers of statics().rows(). Those of dependent rows are not unique; one solution is returned.
  [[nodiscard]] const VecX& multipliers() const { return landscape_->multipliers(); }
  [[nodiscard]] const Statics& statics() const { return statics_; }
  /// Returns the directions without stiffness at the equilibrium, each described by its largest component.
  [[nodiscard]] const std::vector<MotionPart>& indifferent() const { return indifferent_; }
  [[nodiscard]] int more_indifferent() const { return more_indifferent_; } ///< number of further directions without stiffness
  /// Returns the unstable equilibria that were found and left on the way, each by the direction in which it was left.
  [[nodiscard]] const std::vector<MotionPart>& left() const { return left_; }
  /// Return the number of directions along which small displacements meet no resistance, at the start and at the end.
  [[nodiscard]] int yielding_at_start() const { return yielding_at_start_; }
  [[nodiscard]] int yielding() const { return yielding_; }
  /// Return the body that moves without end, and the force or torque that drives it.
  [[nodiscard]] const MotionPart& runaway() const { return runaway_; }
  [[nodiscard]] double driving_force() const { return driving_force_; }

private:
  enum class Hold : unsigned char { none, sticks, slides };
  void measure_scene();
  [[nodiscard]] bool is_exhausted() const; ///< the search has taken as many evaluations as it may
  void linearise();
  [[nodiscard]] double step_size(const VecX& step) const;
  bool move_to(const std::vector<double>& from, const VecX& step);
  bool project();
  bool advance(VecX step);
  [[nodiscard]] int measurement_count(const VecX& step) const;
  bool land(const std::vector<double>& from, VecX& step);
  [[nodiscard]] double slope_along(const VecX& step) const;
  [[nodiscard]] double first_contact(const std::vector<double>& from, const VecX& step);
  void refine_first_contact(const std::vector<double>& from, const VecX& step, double before, double& share);
  [[nodiscard]] VecX displacement_from(const std::vector<double>& from) const;
  void adapt_region(double factor, const VecX& step, bool is_straight);
  [[nodiscard]] double correct(const VecX& step, const std::vector<double>& from, double slope);
  [[nodiscard]] bool loads_friction() const;
  [[nodiscard]] double first_load(const std::vector<double>& from, const VecX& step, double low, double high);
  void follow_friction(const std::vector<double>& from);
  [[nodiscard]] bool is_near_touch(int f) const;
  void anchor(int f, bool is_switched);
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
  double length_ = 1.0, reach_ = 1.0; ///< size of the model and its largest coordinate, m
  double radius_ = 0.0, turn_ = 0.0;  ///< trust region for displacements, m, and rotations, rad
  VecX scale_;                        ///< per coordinate: 1 for lengths, 1/radius of the body for angles
  VecX mass_;                         ///< masses of the scaled coordinates
  std::unique_ptr<Landscape> landscape_;
  std::unique_ptr<Clearance> clearance_;
  std::vector<double> start_;
  double far_ = 1e4;                            ///< sizes of the model; beyond it a body counts as moving without end
  double many_turns_ = 40.0 * std::numbers::pi; ///< the same for rotations, rad
  int most_iterations_ = 0;
  bool keeps_directions_ = false; ///< of sliding friction
  double residual_ = 0.0;
  std::vector<Hold> hold_; ///< per friction element
  /// Poses of the two bodies of a friction row when they first touched.
  struct Touch {
    int a = -1, b = -1; ///< bodies; −1: they have not touched, or have slid since
    Motion<double> at_a, at_b;
    bool has_switched = false; ///< the contact point has changed in this search
  };
  std::vector<Touch> touch_;             ///< per friction element
  std::vector<Motion<double>> at_touch_; ///< scratch of anchor(): the bodies, two of them at their touch
  std::vector<char> left_out_;           ///< for each friction row: left out, since it depends on other sticking rows
  std::vector<MotionPart> indifferent_, left_;
  MotionPart runaway_;
  double driving_force_ = 0.0;
};

} // namespace steplap
