// One part of an elastic beam between two rigid bodies, taken at its middle: what a beam element of length h between two nodes is.
//
// Two markers lie together in the middle of the part, half of its length from the node of either body. With u, v, along the axis and to the left of it,
// where marker a is as seen from b, turned back by half of the relative angle θ (so that neither body is preferred):
//   q = u + (1/2 + r²/10) v²/h − h θ²/12        stretch of the bent line
//   U = ½ k_x q² + ½ k_v v² + ½ k_θ θ²,          k_x = E A/h,  1/k_v = h³/(12 E I) + h/(G A_s),  k_θ = E I/h
// r = k_v h³/(12 E I) is the share of bending in v: 1 where it does not shear. At the middle of a part moment and shear force do not couple,
// and U is that of the elastic line under loads at the nodes, exactly. The squares are what its length takes up by bending, ½ ∫ w'² less
// what the way between the nodes loses: with them a tension stiffens it as that of a beam does (the consistent geometric stiffness), and
// a compression buckles it. Without them rigid segments that may slide across each other would give way under a tension of k_v h.
// Each has a damper, τ times as strong: N = k_x (q + τ q̇), and so on. Relative angles of a part of some tenths are small enough.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct BeamPart : Element {
  std::string a, b = "ground";           ///< markers in its middle, on the bodies ahead and behind
  Vec2 axis = Vec2::UnitX();             ///< along the beam towards a, in b's axes
  double length = 0.0;                   ///< h, m
  double axial_stiffness = 0.0;          ///< E A, N
  double bending_stiffness = 0.0;        ///< E I, N m²
  std::optional<double> shear_stiffness; ///< G A_s, N; not given: it does not shear
  double damping_time = 0.0;             ///< τ, s
};

[[nodiscard]] const ElementKind& beam_part_kind();

} // namespace steplap
