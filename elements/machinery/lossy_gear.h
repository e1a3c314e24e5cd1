// Gear with losses: two shafts on a carrier with a ratio, elastic teeth, and friction proportional to the load.
//
//   δ = (θ_a − θ_c) − i (θ_b − θ_c),   M = k δ + c δ̇
//
// The tooth forces act with −M on shaft a, i M on shaft b and (1 − i) M on the carrier c. The tooth friction is Coulomb friction between
// shaft a and the carrier with the bound ν |M|, and sticks exactly:
//
//   a drives:  τ_a = (1 + ν) M,   efficiency η = 1/(1 + ν)
//   b drives:  τ_a = (1 − ν) M,   efficiency 2 − 1/η, as for screws (G. Niemann, Maschinenelemente)
//
// For η ≤ 1/2 b cannot drive a: the gear is self-locking for any load. Only moments act; forces on the bearings of the shafts are not
// modelled.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct LossyGear : Element {
  std::string a, b, carrier = "ground";  ///< shafts a and b; body that carries both
  double ratio = 1.0;                    ///< i = ω_a/ω_b relative to the carrier; negative: opposite directions
  double efficiency = 1.0;               ///< η when a drives
  double stiffness = 0.0, damping = 0.0; ///< stiffness, N m/rad, and damping, N m s/rad, referred to shaft a
};

[[nodiscard]] const ElementKind& lossy_gear_kind();

} // namespace steplap
