// A force or moment on a along a coordinate relative to b, given by a formula (mbd/system/motion_formula.h); the opposite acts on b. For
// drag, magnets, tyres, thrusters, controllers.
//
//   coordinate   value                                     rate                                       acts
//   x, y         position of marker a in marker b's axes   its rate                                   along that axis, at marker a
//   distance     distance of the markers                   its rate                                   along the line between them
//   angle        of a relative to b, minus marker angles   its rate                                   as a moment
//   own_x, own_y none                                      velocity of marker a relative to b along   along that axis, at marker a
//                                                          marker a's own axis
//
// A positive value acts towards larger values of the coordinate. Its power f·rate is counted as work (default, for drives), or, with energy
// = "dissipated", as heat, negative if it drives.
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
