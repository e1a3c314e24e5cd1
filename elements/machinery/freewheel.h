// Freewheel: a one-way clutch between two bodies on one axis, as of a bicycle's hub, a starter, a backstop.
//
// With ω = ω_a − ω_b counted in the direction in which a may overrun b, and M the couple on a in that direction:
//   ω > 0: M = −drags                   a overruns b
//   ω = 0: −drags ≤ M ≤ holds           locked: b drives a
//   ω < 0: M = holds                    it slips, if what it holds has a bound
// An exact constraint while it is locked; free from the moment on at which a would be braked by it; locked again where ω has come down
// to zero. It has no play and no spring. Where the bodies begin, or are brought by a blow, to turn against a lock without bound, they
// are joined at once: by an impulse, without rebound (mbd/events/blow.h).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Freewheel : Element {
  std::string a, b = "ground";
  std::string free = "counter_clockwise"; ///< or "clockwise": how a may overrun b
  std::optional<double> holds;            ///< N m; not given: whatever it takes
  double drags = 0.0;                     ///< N m, while it overruns
};

[[nodiscard]] const ElementKind& freewheel_kind();

} // namespace steplap
