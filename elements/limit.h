// Limit: stops at the ends of a coordinate's range, for joints (an angle, a slide) or between any two markers.
//
// Beyond a stop it presses back like a unilateral contact (contact_laws.h, Kelvin–Voigt without adhesion):
// f = max(0, −kδ − cδ̇), δ < 0 the depth; between the stops it does nothing. f is along the coordinate: positive
// at the lower stop, negative at the upper one.
//
// What is given at its stop, to the digits that poses are known to, begins in touch with it: nothing is reached then,
// and where the motion leads away from there it leaves its stop at once. Rounding has no say in either.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Limit : Element {
  std::string a, b = "ground";
  std::string coordinate = "angle";   ///< angle, x, y (marker b's axes), distance
  std::optional<double> lower, upper; ///< from the reference pose; distance: the distance itself
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> restitution; ///< instead of damping (restitution.h)
};

[[nodiscard]] const ElementKind& limit_kind();

} // namespace steplap
