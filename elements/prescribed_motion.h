// Prescribed motion: a coordinate of a against b follows a signal, exactly.
//
// The signal gives the coordinate's acceleration, velocity or position; the others are its exact
// integrals and derivatives (signal.h), starting from the initial pose (acceleration: and velocity). A position is the
// coordinate itself, or what it is beyond its value in the reference pose; where the reference pose is not where the
// signal begins, the body would have to jump there, which
// compile() refuses.
// The multiplier is the force or couple on a that it takes (the brake force, say).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct PrescribedMotion : Element {
  std::string a, b = "ground";
  std::string coordinate = "x"; ///< x, y (marker b's axes), angle, distance
  std::string signal;
  std::string as = "acceleration";
  std::string zero = "origin"; ///< of a position: the coordinate's own, or "reference", its value in the reference pose
};

[[nodiscard]] const ElementKind& prescribed_motion_kind();

} // namespace steplap
