// Wound rope: tension only, between two wheels on which its ends are wound: a hoist's drum, a side of a belt, a heavy
// pulley.
//
// With d from the centre of a's wheel to that of b's, the radii r_a, r_b counted positive where turning the wheel
// counter-clockwise winds the rope up, and c = r_a + r_b, the straight part runs along
//   u = (s d − c ẑ×d)/d²,  s = √(d² − c²) its length,
// and leaves the wheels at r_a ẑ×u and −r_b ẑ×u from their centres. What is taken up of the rope since the reference
// pose,
//   e = s − c φ + r_a θ_a + r_b θ_b less its value there,  φ the angle of u against the reference pose,
// has the rate u·(v_b − v_a) of the two points where it leaves: the wound parts, which do not slip, and the way by
// which these points move are both in it. T = max(0, k (e − e₀) + c_d ė) while e > e₀, else 0 (contact_laws.h, of the
// coordinate −e). Potential ½ k (e − e₀)². The radii stay as they are: no layers.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct WoundRope : Element {
  std::string a, b = "ground";
  double radius_a = 0.0, radius_b = 0.0;
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> pretension; ///< in the reference pose
  std::optional<double> slack;      ///< in the reference pose
};

[[nodiscard]] const ElementKind& wound_rope_kind();

} // namespace steplap
