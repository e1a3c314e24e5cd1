// One-way clutch: a one-dimensional friction element that resists motion in one direction without a limit of force.
//
// A bounded friction force cannot reverse a velocity instantaneously, but an unbounded one can. If the bodies are made to move in the
// locked direction, for example by an impact, an impulse stops the relative motion, as for ropes (mbd/events/blow.h).
#pragma once

#include "mbd/system/one_sided_row.h"

namespace steplap {

class OneWayLock : public BoundedFriction {
public:
  static constexpr double k_without_bound = 1e30; ///< bound that no machine reaches, N or N m

  int impact = 0; ///< index in State::impacts

  /// Returns the sign of the rate that is locked; 0 if the force is bounded in both directions.
  [[nodiscard]] virtual int refuses() const = 0;
  /// Returns the friction in the free direction, N or N m.
  [[nodiscard]] virtual double drag() const = 0;
};

/// Returns the element as a one-way clutch that locks; null for other kinds of friction, and for clutches with finite bounds.
[[nodiscard]] inline const OneWayLock* one_way_lock(const FrictionUnit& unit) {
  return unit.clutch && unit.clutch->refuses() != 0 ? unit.clutch : nullptr;
}

/// Returns the index of the element in State::impacts; −1 for elements without impacts.
[[nodiscard]] inline int impact_index(const FrictionUnit& unit) {
  if (unit.rope) return unit.rope->impact;
  const OneWayLock* const lock = one_way_lock(unit);
  return lock ? lock->impact : -1;
}

} // namespace steplap
