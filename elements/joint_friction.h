// Dry friction of a bearing, a guide, a brake or a clutch: sticks exactly while the couple (force) that it takes is within
// `holds`, slides against `drags`, towards which it falls with the rate if it has a Stribeck velocity, and a viscous part. A signal
// multiplies all of them: the pressure of a brake.
//
// The bound is a constant (a preloaded bearing, a seal) or a function of time, not μ times the joint's own reaction: reactions are
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
  std::optional<double> stribeck_velocity; ///< rad/s or m/s
  double viscous = 0.0;                    ///< N m s/rad or N s/m
  std::string signal;                      ///< multiplies all of them; empty: 1
};

[[nodiscard]] const ElementKind& joint_friction_kind();

} // namespace steplap
