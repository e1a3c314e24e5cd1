// Skate: a body that runs along one of its own directions and not across it, in a plane seen from above: the wheels of an axle, a
// knife edge, a keel, the blade of an ice skate.
//
// With e the direction in which it runs and n = ẑ×e, both fixed in a, and v the velocity of marker a against the plane of b below it,
// n·v = 0 is held. That is the rate of no coordinate: such a body can be brought anywhere, and no place is held. So nothing drifts
// that had to be projected, and only velocities are. Its force is along n and does no work.
//
// Without `grip` it holds whatever it takes. With it, it is friction along n (coulomb_friction.h, joint_friction.h): held exactly up
// to `grip`, beyond it slides sideways against `drags`. Both are forces, since a plane seen from above has no normal forces.
//
// It says nothing of motion along e: rolling resistance, brakes and engines are a force by formula along own_x.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>

namespace steplap {

struct Skate : Element {
  std::string a, b = "ground";
  Vec2 axis{1.0, 0.0};         ///< in marker a's axes: where it runs
  std::optional<double> grip;  ///< N; none: whatever it takes
  std::optional<double> drags; ///< N
};

[[nodiscard]] const ElementKind& skate_kind();

} // namespace steplap
