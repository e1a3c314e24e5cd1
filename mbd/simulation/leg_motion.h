// Directions of the configuration space in which a leg of a run moves.
//
// A symmetrical machine keeps its symmetry up to rounding, whatever the axes. The directions in which it does not move are the orthogonal
// complement of those in which it does. The displacements from the initial pose of a leg are therefore collected in a basis that is
// orthonormal in the mass metric. A direction is added when a displacement has a component orthogonal to the basis that is larger than
// k_moved, relative to the size of some body. Rounding errors that grow at an unstable equilibrium stay below this until shortly before
// they become visible.
#pragma once

#include "mbd/system/system.h"

#include <memory>
#include <vector>

namespace steplap {

/// Smallest displacement that counts as motion, relative to a body's radius of gyration, or angle in rad. Deflections of stiff contacts by
/// a body's weight are larger; rounding errors are a billion times smaller.
inline constexpr double k_moved = 1e-6;

/// Orthonormal basis of the displacements from one pose.
class MotionSpan {
public:
  /// `begin`: pose from which displacements are measured.
  MotionSpan(const System& system, const State& begin);
  /// Adds the pose `q` at time t, s. Returns true if this added a direction.
  bool add(double t, const std::vector<double>& q);
  /// Returns the basis as it was for poses before t, s.
  [[nodiscard]] MotionSpan before(double t) const;

  /// Returns the basis vectors; three numbers for each body except the ground, in kg^½ m: √m x, √m y, √J θ.
  [[nodiscard]] const std::vector<std::vector<double>>& directions() const { return directions_; }
  /// Returns the times, s, ascending, at which the directions were added.
  [[nodiscard]] const std::vector<double>& since() const { return since_; }
  /// Returns √m, √m, √J for each body except the ground.
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  /// Removes from a weighted displacement its component in the span.
  void remove(std::vector<double>& displacement) const;

private:
  std::vector<double> begin_, weights_, least_; ///< initial pose; square roots of masses; smallest displacement that counts, weighted
  std::vector<std::vector<double>> directions_;
  std::vector<double> since_;        ///< per direction: time at which it was added, s
  std::vector<double> displacement_; ///< scratch
};

/// Motion of one leg of a run, during which the same elements are active.
struct LegMotion {
  std::shared_ptr<const System> system; ///< system of the leg; null: the system of the run
  std::size_t past_legs = 0;            ///< number of legs before this one (Simulation::past_legs)
  State begin;                          ///< initial state, after impulses and projection
  double end = 0.0;                     ///< time of the end, s
  std::vector<State> states;            ///< recorded states in ascending time, evenly distributed over the steps
  MotionSpan moved;                     ///< directions in which the leg moved
};

/// Records the motion of all legs of a run.
class MotionNotes {
public:
  /// To be called at the start of a leg. `system`: null if the leg uses the system of the run; `of_leg`: the system of the leg in any case.
  void begin_leg(std::shared_ptr<const System> system, const System& of_leg, std::size_t past_legs, State begin);
  /// Returns true if the state after this step should be recorded. Intervals grow while no new direction is found.
  [[nodiscard]] bool wants_step() { return ++steps_ >= next_; }
  /// Records a state, after a step or at the end of a leg.
  void note(const State& state);
  /// Returns scratch memory for a state of the present leg.
  [[nodiscard]] State& scratch() { return scratch_; }

  /// Returns the legs recorded.
  [[nodiscard]] std::vector<LegMotion> legs() && { return std::move(legs_); }

private:
  std::vector<LegMotion> legs_;
  State scratch_;
  long steps_ = 0, next_ = 1;            ///< number of steps of this leg so far; number of the next step to be recorded
  long recorded_states_ = 0, quiet_ = 0; ///< number of states recorded in this leg; consecutive ones without a new direction
  long stride_ = 1, keep_stride_ = 1;    ///< steps between recorded states; recorded states between kept ones
};

} // namespace steplap
