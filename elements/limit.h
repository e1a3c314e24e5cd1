// Limit: stops at the ends of the range of a coordinate, for joints (angle, slide) or any two markers.
//
// Beyond a stop the force is that of a unilateral contact (contact_laws.h, Kelvin–Voigt without adhesion), f = max(0, −kδ − cδ̇) with δ < 0
// the penetration; between the stops it is zero. f acts along the coordinate: positive at the lower stop, negative at the upper one.
//
// A coordinate that starts at a stop, within the accuracy of poses, starts in contact. This start is not an event. If the motion leads away
// from the stop, the coordinate leaves it at once. Rounding errors decide neither.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Limit : Element {
  std::string a, b = "ground";
  std::string coordinate = "angle";   ///< angle, x, y (marker b's axes) or distance
  std::optional<double> lower, upper; ///< stops, measured from the reference pose; for `distance` the distance itself
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> restitution; ///< coefficient of restitution, replaces damping (restitution.h)
};

[[nodiscard]] const ElementKind& limit_kind();

} // namespace steplap
