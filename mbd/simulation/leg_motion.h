// The directions of the configuration space in which a leg of a run moves.
//
// A machine that is symmetrical keeps its symmetry to rounding, whatever axes it is described in: what it does not do is the
// complement of what it does. So the displacements from the pose in which a leg begins are collected as an orthonormal basis in the
// masses' metric. A direction counts as moved once a displacement goes beyond the basis by more than k_moved of some body's size.
// Rounding that grows where a machine balances stays below that until shortly before it is seen by anybody.
#pragma once

#include "mbd/system/system.h"

#include <memory>
#include <vector>

namespace steplap {

/// Share of a body's radius of gyration, or angle in rad, from which on a displacement counts as a motion. The deflections of stiff contacts
/// under the weight of a body are larger, rounding is a billion times smaller.
inline constexpr double k_moved = 1e-6;

/// Basis of the displacements from one pose.
class MotionSpan {
public:
  /// `begin`: the pose that displacements are measured from.
  MotionSpan(const System& system, const State& begin);
  /// True if the pose `q`, at t, added a direction.
  bool add(double t, const std::vector<double>& q);
  /// The span of the poses before t.
  [[nodiscard]] MotionSpan before(double t) const;

  /// Orthonormal; three numbers for each body but the ground, in kg^½ m: √m x, √m y, √J θ.
  [[nodiscard]] const std::vector<std::vector<double>>& directions() const { return directions_; }
  /// When each of them was added, s; ascending.
  [[nodiscard]] const std::vector<double>& since() const { return since_; }
  /// √m, √m, √J of each body but the ground.
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  /// Takes from a displacement, weighted, what lies within the span.
  void remove(std::vector<double>& displacement) const;

private:
  std::vector<double> begin_, weights_, least_; ///< pose; √ of masses; displacement that counts, weighted
  std::vector<std::vector<double>> directions_;
  std::vector<double> since_;        ///< s
  std::vector<double> displacement_; ///< scratch
};

/// A leg of a run: as far as the same elements act.
struct LegMotion {
  std::shared_ptr<const System> system; ///< in which the leg was made; null: the one of the run
  std::size_t past_legs = 0;            ///< legs of the run that ended before it (Simulation::past_legs)
  State begin;                          ///< behind the blows and the projection that a leg begins with
  double end = 0.0;                     ///< s
  std::vector<State> states;            ///< some states after its steps, ascending in time and evenly spread over its steps
  MotionSpan moved;                     ///< the directions in which it moved
};

/// Notes the legs of a run.
class MotionNotes {
public:
  /// A leg begins. `system`: null if it is the one that the run was made in, `of_leg`.
  void begin_leg(std::shared_ptr<const System> system, const System& of_leg, std::size_t past_legs, State begin);
  /// Is a look at the state after this step worth its cost? Looks become rarer where they find nothing new.
  [[nodiscard]] bool wants_step() { return ++steps_ >= next_; }
  /// The state after a step, or at the end of a leg.
  void note(const State& state);
  /// Room for a state that is to be noted, of the present leg's size.
  [[nodiscard]] State& scratch() { return scratch_; }

  /// The legs noted so far.
  [[nodiscard]] std::vector<LegMotion> legs() && { return std::move(legs_); }

private:
  std::vector<LegMotion> legs_;
  State scratch_;
  long steps_ = 0, next_ = 1;         ///< of this leg: made; after which the next look is due
  long looks_ = 0, quiet_ = 0;        ///< looks at this leg; of them without a new direction, one after the other
  long stride_ = 1, keep_stride_ = 1; ///< steps between looks; looks between states that are kept
};

} // namespace steplap
