// Elastic part of a beam between two rigid bodies, a beam element of length h between two nodes, formulated at its middle.
//
// Two markers coincide in the middle of the part, h/2 from the node of either body. u and v are the displacements of marker a relative to b
// along the axis and to its left, rotated back by half of the relative angle θ, so that neither body is preferred:
//
//   q = u + (1/2 + r²/10) v²/h − h θ²/12        elongation of the bent line
//   U = ½ k_x q² + ½ k_v v² + ½ k_θ θ²,          k_x = E A/h,  1/k_v = h³/(12 E I) + h/(G A_s),  k_θ = E I/h
//
// r = k_v h³/(12 E I) is the contribution of bending to v; 1 without shear deformation. At the middle of a part bending moment and shear
// force are uncoupled, and U is exactly that of Euler–Bernoulli theory for loads at the nodes. The quadratic terms of q are the shortening
// by bending, ½ ∫ w'², minus the shortening of the distance of the nodes. They give the consistent geometric stiffness: tension stiffens
// the beam, compression buckles it. Without them rigid segments that may shift relative to each other would be unstable under a tension of
// k_v h. Each stiffness has a damper: N = k_x (q + τ q̇), and so on. Valid for relative angles of a part up to some tenths.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct BeamPart : Element {
  std::string a, b = "ground";           ///< coincident markers in the middle of the part, on the bodies of the two nodes
  Vec2 axis = Vec2::UnitX();             ///< unit vector along the beam towards a, in b's axes
  double length = 0.0;                   ///< length h, m
  double axial_stiffness = 0.0;          ///< axial stiffness E A, N
  double bending_stiffness = 0.0;        ///< bending stiffness E I, N m²
  std::optional<double> shear_stiffness; ///< shear stiffness G A_s, N; not given: no shear deformation
  double damping_time = 0.0;             ///< damping time τ, s
};

[[nodiscard]] const ElementKind& beam_part_kind();

} // namespace steplap
