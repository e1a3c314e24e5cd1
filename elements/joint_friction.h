// Dry friction in a bearing, guide, brake or clutch. It sticks exactly while the moment (or force) is within `holds`, and slides against
// `drags`, which decreases with the rate if a Stribeck velocity is given, plus a viscous part. A signal multiplies all of them, for example
// a brake pressure.
//
// The bound is a constant (a preloaded bearing, a seal) or a function of time, not μ times the joint's reaction. Reactions are multipliers,
// and with bounds that depend on them the mode problem (docs/explanation/theory.md) would not be convex and could have several solutions or
// none (Painlevé). For friction that depends on a load use bearing or coulomb_stick, whose reaction is a function of the state.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct JointFriction : Element {
  std::string a, b = "ground";
  std::string coordinate = "angle"; ///< angle, x, y (marker b's axes) or distance
  double holds = 0.0;               ///< static bound, N m or N
  std::optional<double> drags;
  std::optional<double> stribeck_velocity; ///< velocity v_s of the Stribeck law, rad/s or m/s
  double viscous = 0.0;                    ///< viscous coefficient, N m s/rad or N s/m
  std::string signal;                      ///< name of the signal that multiplies all bounds; empty: factor 1
};

[[nodiscard]] const ElementKind& joint_friction_kind();

} // namespace steplap
