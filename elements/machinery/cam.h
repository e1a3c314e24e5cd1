// Cam and follower: a marker is lifted along an axis by a curve of another body's angle.
//
//   δ = e·(p_a − p_b) − h(φ) − c_0,   φ = θ_cam − θ_b + φ_0
// is the gap between follower and cam, e fixed in b, which carries both. The force f ≥ 0 along e at a, its opposite at the same place of b, the
// couple −f h' on the cam and its opposite on b: no power but f δ̇. f = max(0, −k δ − c δ̇) while δ < 0 (contact_laws.h), so that the follower
// leaves the cam where its force ends, and comes back to it; with `holds` a groove holds it both ways and f = −k δ − c δ̇. h is the lift diagram:
// what shape of cam and follower gives it is not asked, nor where on the cam the force acts. Friction on it is left out.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Cam : Element {
  std::string a, b = "ground", cam; ///< follower; frame; body that turns
  Vec2 axis = Vec2::UnitY();        ///< in b's axes
  std::vector<Vec2> lift;           ///< [angle, lift], rad, m
  std::string formula;              ///< lift over the angle `value`; instead of points
  double start_angle = 0.0;         ///< rad: φ in the reference pose
  double gap = 0.0;                 ///< m, in the reference pose; negative: pressed
  bool holds = false;
  double stiffness = 0.0, damping = 0.0; ///< N/m, N s/m
};

[[nodiscard]] const ElementKind& cam_kind();

} // namespace steplap
