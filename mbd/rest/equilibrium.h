// Static equilibrium: the pose in which nothing accelerates, with contacts, friction and preload.
//
// The bodies move downhill along the constraints (descent.h) until forces balance: suspended bodies swing down, resting ones settle, driven
// coordinates stay. Friction that gains its load holds its rows at that pose. If it would have to exceed its bound, it slides at the bound
// until it sticks again. Of several equilibria this finds the nearest one downhill. Unstable equilibria are left.
//
// The descent fails if a body would move without end, if friction between touching bodies gives way (a ladder that slides down may come to
// rest somewhere, but it does not stand), or if the friction of a joint is overloaded. Then a machine with contacts or friction is released
// and simulated with strong damping (settling.h), and the search is repeated from its final pose. If friction holds that rest, it is one of
// many and depends on the path.
#pragma once

#include "mbd/rest/descent.h"

#include <string>
#include <vector>

namespace steplap {

/// Margin of a sticking friction element.
struct FrictionMargin {
  int friction = 0;       ///< index in System::frictions
  double used = 0.0;      ///< utilisation: wrench over the largest one in the same direction
  bool is_shared = false; ///< the element shares a load; `used` is the least common utilisation with which the group can carry it
};

/// Equilibrium and how it was found.
struct Equilibrium {
  State state;                         ///< at rest, with its modes and friction phases
  double residual = 0.0;               ///< largest remaining acceleration, m/s² or rad/s²
  double moved = 0.0;                  ///< largest displacement from the start, m
  int iterations = 0;                  ///< steps of the descent
  bool is_settled = false;             ///< found by releasing the damped machine
  int settling_steps = 0;              ///< time steps of that simulation
  bool hangs_on_way = false;           ///< held by friction after sliding or settling: one equilibrium of many
  std::vector<FrictionMargin> margins; ///< margins of the sticking elements
  std::vector<MotionPart> indifferent; ///< directions without resistance, each by its largest component
  int more_indifferent = 0;            ///< number of further such directions
  std::vector<MotionPart> left;        ///< unstable equilibria on the way
  std::vector<int> slid;               ///< friction elements that slid before they stuck
  std::vector<int> sliding;            ///< of a load that grows in increments: friction elements that slide on as it grows
  int turned_body = 0;                 ///< body without joints to the ground that turned furthest, if it tipped over; else 0
  double turned = 0.0;                 ///< its rotation, rad
  std::vector<int> moving_drives;      ///< elements whose drives have a velocity or acceleration; they are held in statics
};

/// Returns the equilibrium found from the pose of `start`. Throws NumericalFailure with the reason and the body that would move if there is
/// none. `algebra`: for tests that compare the two.
[[nodiscard]] Equilibrium find_equilibrium(const System& system, const State& start, RestAlgebra algebra = RestAlgebra::by_size);

/// Returns the direction as text: "'bob' along -x", "'bob' turning clockwise".
[[nodiscard]] std::string part_text(const System& system, const MotionPart& part);
/// Returns notes on an equilibrium, one sentence each: unstable equilibria that were left, directions without resistance, elements that
/// slid, moving drives.
[[nodiscard]] std::vector<std::string> remarks_on(const System& system, const Equilibrium& found);

} // namespace steplap
