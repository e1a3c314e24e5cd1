// Dry friction of a bearing or guide with a constant bound: sticks exactly while the couple (force) that it
// takes is within `holds`, slides against `drags`.
//
// The bound is a constant (a preloaded bearing, a seal), not μ times the joint's own reaction: reactions are
// multipliers, and with bounds that depend on them the mode problem (physics of friction modes, docs/explanation/theory.md)
// would no longer be convex: it may have several answers or none (Painlevé). Friction that follows a load is
// friction on a contact, whose normal force is a function of the state: coulomb_stick.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct JointFriction : Element {
  std::string a, b = "ground";
  std::string coordinate = "angle"; ///< angle, x, y (marker b's axes), distance
  double holds = 0.0;               ///< N m or N
  std::optional<double> drags;
};

[[nodiscard]] const ElementKind& joint_friction_kind();

} // namespace steplap
