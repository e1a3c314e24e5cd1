// Cam and follower: a marker is lifted along an axis by a function of another body's angle.
//
//   δ = e·(p_a − p_b) − h(φ) − c_0,   φ = θ_cam − θ_b + φ_0
//
// is the gap between follower and cam, with e fixed in b, which supports both. The force f ≥ 0 acts along e on a at marker a, and in the
// opposite direction on b at the same point; the moment −f h' acts on the cam and its opposite on b. The power of all forces is f δ̇. f =
// max(0, −k δ − c δ̇) for δ < 0 (contact_laws.h), so that the follower separates when the force becomes zero. With `holds` (a groove) the
// constraint acts in both directions, f = −k δ − c δ̇. h is the lift diagram; the shapes of cam and follower and the position of the
// contact point are not considered, nor is friction.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Cam : Element {
  std::string a, b = "ground", cam; ///< follower; frame of the follower's guide; rotating body
  Vec2 axis = Vec2::UnitY();        ///< direction e in b's axes
  std::vector<Vec2> lift;           ///< points [angle, lift], rad and m
  std::string formula;              ///< lift as a formula of the angle, called `value` in it; replaces the points
  double start_angle = 0.0;         ///< φ in the reference pose, rad
  double gap = 0.0;                 ///< gap in the reference pose, m; negative: compressed
  bool holds = false;
  double stiffness = 0.0, damping = 0.0; ///< contact stiffness, N/m; damping, N s/m
};

[[nodiscard]] const ElementKind& cam_kind();

} // namespace steplap
