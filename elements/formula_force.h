// Force by formula: a force or couple along a coordinate of a against b whose value is a formula (mbd/system/motion_formula.h),
// its opposite on b. Drag, magnets, tyres, thrusters, controllers.
//
//   coordinate   value                                     rate            acts
//   x, y         of marker a in marker b's axes            its rate        along that axis at marker a
//   distance     of the markers                            its rate        along the line between them
//   angle        of a against b, less the markers' angles  its rate        as a couple
//   own_x, own_y none                                      of marker a against b, along marker a's own axis     along that axis at marker a
// A positive value acts towards larger values of the coordinate. Its power on the two bodies is f·rate. It is booked as work (of a
// drive: the default), or with energy = "dissipated" as heat, negative where it drives.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct FormulaForce : Element {
  std::string a, b = "ground";
  std::string coordinate = "x";
  std::string formula;
  std::string energy = "work";
};

[[nodiscard]] const ElementKind& formula_force_kind();

} // namespace steplap
