// Maxwell element: a spring in series with a damper, for pads, seals and preloads that creep.
//
// The inner state is the stretch e of the spring. With the rate δ̇ of the measure, f on a along the measure, and the relaxation time τ = c/k:
//
//   f = −k e      ė = δ̇ − e/τ      stored energy ½ k e²      dissipated power (k e)²/c
//
// A sudden elongation d gives −k d e^(−t/τ); a harmonic one of angular frequency ω the complex stiffness k iωτ/(1 + iωτ). A search for
// equilibrium keeps e, so an element without preload carries nothing there: it has relaxed.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Maxwell : Element {
  std::string a, b = "ground";
  std::optional<Vec2> axis; ///< in marker b's axes; not given: point to point
  double across = 0.0;      ///< distance of its ends across the plane, m
  double stiffness = 0.0;   ///< k of one element, N/m
  double damping = 0.0;     ///< c of one element, N s/m
  double preload = 0.0;     ///< f of all at the start, N
  long count = 1;
};

[[nodiscard]] const ElementKind& maxwell_kind();

} // namespace steplap
