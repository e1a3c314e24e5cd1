// Gear with losses: two shafts on one carrier, whose angles keep a ratio but for elastic teeth, with friction in proportion to the load.
//
//   δ = (θ_a − θ_c) − i (θ_b − θ_c),   M = k δ + c δ̇
// The teeth turn shaft a with −M, shaft b with i M and the carrier c with (1 − i) M. What the teeth lose by sliding on each other is
// Coulomb friction of shaft a against the carrier with the bound ν |M|, which sticks exactly:
//   a drives:  τ_a = (1 + ν) M,   efficiency η = 1/(1 + ν)
//   b drives:  τ_a = (1 − ν) M,   efficiency 2 − 1/η, as of screws (G. Niemann, Maschinenelemente)
// and with η ≤ 1/2 b cannot drive a: the gear locks itself, whatever the load. Only couples act: bearings of the shafts do not feel the forces
// between the teeth.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct LossyGear : Element {
  std::string a, b, carrier = "ground";  ///< shafts; what bears both
  double ratio = 1.0;                    ///< i = ω_a/ω_b against the carrier; negative: they turn against each other
  double efficiency = 1.0;               ///< η, where a drives
  double stiffness = 0.0, damping = 0.0; ///< N m/rad, N m s/rad, at shaft a
};

[[nodiscard]] const ElementKind& lossy_gear_kind();

} // namespace steplap
