// Static equilibrium: a pose in which nothing accelerates, with contacts, friction and preload.
//
// The bodies move downhill along the constraints (descent.h) until forces balance: suspended bodies swing down, resting ones settle, driven
// coordinates stay. Friction that gains normal force holds its rows at that pose. If it would have to exceed its bound, it slides at the
// bound until it sticks again. Of several equilibria the nearest one downhill is found. Unstable equilibria are left.
//
// The descent fails if a body would move without end, if friction between touching bodies gives way (a ladder that slides down may come to
// rest somewhere, but it does not stand), or if the friction of a joint is overloaded. A machine with contacts or friction is then released
// and simulated with strong damping (settling.h), and the search is repeated from its final pose. An equilibrium that friction holds after
// this is one of many, and depends on the path.
#pragma once

#include "mbd/rest/motion_part.h"
#include "mbd/system/system.h"

#include <string>
#include <vector>

namespace steplap {

/// Utilisation of a sticking friction element.
struct FrictionMargin {
  int friction = 0;       ///< index in System::frictions
  double used = 0.0;      ///< utilisation: wrench over the largest admissible one in the same direction
  bool is_shared = false; ///< shares a load with other elements; `used` is the least common utilisation with which they can carry it
};

/// Equilibrium and how it was found.
struct Equilibrium {
  State state;                         ///< at rest, with its modes and friction phases
  double residual = 0.0;               ///< largest remaining acceleration, m/s² or rad/s²
  double moved = 0.0;                  ///< largest displacement from the start, m
  int iterations = 0;                  ///< steps of the descent
  bool is_settled = false;             ///< found by releasing the damped machine
  int settling_steps = 0;              ///< time steps of that simulation
  bool depends_on_path = false;        ///< held by friction after sliding or settling, so one equilibrium of many
  std::vector<FrictionMargin> margins; ///< margins of the sticking elements
  std::vector<MotionPart> indifferent; ///< directions without stiffness, each by its largest component
  int more_indifferent = 0;            ///< number of further directions without stiffness
  std::vector<MotionPart> left;        ///< unstable equilibria that were left
  std::vector<int> slid;               ///< friction elements that slid before they stuck
  int turned_body = 0;                 ///< body without joints to the ground that turned furthest, if it tipped over; else 0
  double turned = 0.0;                 ///< its rotation, rad
  std::vector<int> moving_drives;      ///< elements whose drives have a velocity or acceleration, which statics ignores
};

/// Returns the equilibrium found from the pose of `start`. If there is none, throws NumericalFailure with the reason and the body that
/// would move. `algebra` selects dense or sparse matrices, for tests that compare the two.
[[nodiscard]] Equilibrium find_equilibrium(const System& system, const State& start, RestAlgebra algebra = RestAlgebra::by_size);

/// Rotation, rad, from which a body without joints to the ground counts as overturned.
inline constexpr double k_overturned = 0.75;
/// Returns for each body whether joints connect it to the ground.
[[nodiscard]] std::vector<char> led_bodies(const System& system);
/// Returns the direction as text for messages: "'bob' along -x", "'bob' turning clockwise".
[[nodiscard]] std::string part_text(const System& system, const MotionPart& part);
/// Returns notes on an equilibrium, one sentence each: unstable equilibria that were left, directions without stiffness, elements that
/// slid, moving drives.
[[nodiscard]] std::vector<std::string> remarks_on(const System& system, const Equilibrium& found);

} // namespace steplap
