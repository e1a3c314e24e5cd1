// Gears: constraints on how two bodies roll on each other. What keeps their distance is not theirs: a revolute
// on a common carrier (or the ground) for each gear, a slide for a rack.
//
//   gear   pitch circles about markers a and b roll on each other, outside or (a) inside b's ring
//   rack   a pitch circle about marker a rolls on a line of b
// The multiplier is the force between the teeth along the common tangent, on a (no pressure angle: its part
// along the line of centres is the bearings' affair). One row each: exact, without backlash.
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
  Vec2 axis{1.0, 0.0}; ///< in marker b's axes; the pinion is on its left
};

[[nodiscard]] const ElementKind& gear_kind();
[[nodiscard]] const ElementKind& rack_kind();

} // namespace steplap
