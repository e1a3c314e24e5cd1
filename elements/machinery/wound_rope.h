// Wound rope: tension only, between two wheels on which its ends are wound, as for the drum of a hoist, one side of a belt, a heavy pulley.
//
// d is the vector from the centre of a's wheel to that of b's. The radii r_a and r_b are positive if counter-clockwise rotation of the
// wheel winds the rope up; c = r_a + r_b. The straight part has the direction
//
//   u = (s d − c ẑ×d)/d²,  s = √(d² − c²) its length,
//
// and leaves the wheels at r_a ẑ×u and −r_b ẑ×u from their centres. The elongation since the reference pose,
//
//   e = s − c φ + r_a θ_a + r_b θ_b − value in the reference pose,  φ the angle of u relative to the reference pose,
//
// has the rate u·(v_b − v_a) of the two material points at which the rope leaves the wheels: it contains the wound length, which does not
// slip, and the displacement of these points. T = max(0, k (e − e₀) + c_d ė) while e > e₀, otherwise 0 (contact_laws.h with the coordinate
// −e). Potential energy ½ k (e − e₀)². The radii are constant: layers are not modelled.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct WoundRope : Element {
  std::string a, b = "ground";
  double radius_a = 0.0, radius_b = 0.0;
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> pretension; ///< tension in the reference pose, N
  std::optional<double> slack;      ///< slack in the reference pose, m
};

[[nodiscard]] const ElementKind& wound_rope_kind();

} // namespace steplap
