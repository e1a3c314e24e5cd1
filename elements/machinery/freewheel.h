// Freewheel: a one-way clutch between two coaxial bodies, as in a bicycle hub, a starter or a backstop.
//
// ω = ω_a − ω_b is positive in the direction in which a may overrun b, and M is the moment on a in that direction:
//
//   ω > 0: M = −drags                   a overruns b
//   ω = 0: −drags ≤ M ≤ holds           locked: b drives a
//   ω < 0: M = holds                    slips, if the bound is finite
//
// The lock is an exact constraint. It releases when it would have to brake a, and locks again when ω has decreased to zero, without
// backlash or elasticity. If the bodies start to rotate against an unbounded lock, or a collision makes them do so, an impulse without
// rebound stops the relative rotation (mbd/events/blow.h).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Freewheel : Element {
  std::string a, b = "ground";
  std::string free = "counter_clockwise"; ///< direction in which a may overrun b: "counter_clockwise" or "clockwise"
  std::optional<double> holds;            ///< torque at which the lock slips, N m; not given: unbounded
  double drags = 0.0;                     ///< drag torque while overrunning, N m
};

[[nodiscard]] const ElementKind& freewheel_kind();

} // namespace steplap
