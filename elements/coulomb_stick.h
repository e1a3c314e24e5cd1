// Coulomb friction under a group of contacts, sticking exactly (paper 2.1.1, physics.md §2, §3).
//
// Sticking: the tangential coordinate s of the last contact point on b's line (Eq. 8) is held at the
// value it had when sticking began, valid while |λ| ≤ μ_s N. Sliding: force −μ_k N σ along ∂s/∂q, with
// the direction σ part of the mode. N = Σ f over the contacts named, functions of the state. The last
// contact point is the rear-most foot while θ_A − θ_B is at least the angle at which both feet touch, the front-most otherwise. That
// angle is zero for feet that stand level in both bodies' axes, as in the paper.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct CoulombStick : Element {
  std::vector<std::string> contacts;
  double static_friction = 0.0;
  std::optional<double> kinetic_friction;
};

[[nodiscard]] const ElementKind& coulomb_stick_kind();

} // namespace steplap
