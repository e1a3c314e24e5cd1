// Prescribed motion: a coordinate of a relative to b follows a signal exactly.
//
// The signal is the acceleration, velocity or position; the others are its exact integrals and derivatives (signal.h). An acceleration
// starts from the initial position and velocity, a velocity from the initial position. A position is the coordinate itself, or its
// difference from the reference pose. If a position signal does not start at the reference pose, compile() reports an error, because the
// body would have to jump. The multiplier is the required force or moment on a, for example the braking force.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct PrescribedMotion : Element {
  std::string a, b = "ground";
  std::string coordinate = "x"; ///< x, y (marker b's axes), angle or distance
  std::string signal;
  std::string as = "acceleration";
  std::string zero = "origin"; ///< zero of a position: "origin" of the coordinate, or "reference" for its value in the reference pose
};

[[nodiscard]] const ElementKind& prescribed_motion_kind();

} // namespace steplap
