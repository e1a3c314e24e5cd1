// Skate: a body that can move along one of its own directions but not across it, in a plane seen from above, such as the wheels of an axle,
// a knife edge, a keel or an ice skate.
//
// With e the direction of motion and n = ẑ×e, both fixed in a, and v the velocity of marker a relative to b's material point below it, the
// constraint is n·v = 0. It is nonholonomic: any position can be reached, only the velocity is constrained, and projection concerns
// velocities only. The force acts along n and does no work.
//
// Without `grip` the constraint is unbounded. With `grip` it is friction along n (coulomb_friction.h, joint_friction.h): exact up to
// `grip`, then sliding sideways against `drags`. Both are forces, since a plane seen from above has no normal forces. Motion along e is
// free: rolling resistance, brakes and drives can be added by a formula_force along own_x.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>

namespace steplap {

struct Skate : Element {
  std::string a, b = "ground";
  Vec2 axis{1.0, 0.0};         ///< direction of motion e in marker a's axes
  std::optional<double> grip;  ///< sideways force at which the skate slides, N; not given: unbounded
  std::optional<double> drags; ///< sideways force while sliding, N
};

[[nodiscard]] const ElementKind& skate_kind();

} // namespace steplap
