// Gears: rolling constraints between two bodies. The distance of their axes must be kept by other elements: a revolute joint on a common
// carrier or on the ground for each gear, a slide for a rack.
//
//   gear   pitch circles about markers a and b roll on each other, a outside or inside b's ring
//   rack   a pitch circle about marker a rolls on a line of b
//
// One row each, exact, without backlash. The multiplier is the tooth force on a along the common tangent. The pressure angle is neglected;
// its radial force would act on the bearings.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Gear : Element {
  std::string a, b;
  double radius_a = 0.0, radius_b = 0.0;
  bool inside = false;
};

struct Rack : Element {
  std::string a, b = "ground";
  double radius = 0.0;
  Vec2 axis{1.0, 0.0}; ///< direction of the rack in marker b's axes; the pinion is on its left
};

[[nodiscard]] const ElementKind& gear_kind();
[[nodiscard]] const ElementKind& rack_kind();

} // namespace steplap
