// A friction element of one dimension that holds without bound against one direction of its rate: a one-way clutch.
//
// No force within a bound turns a rate round at once, but what has no bound does: where its bodies begin, or are brought by a blow,
// to move the way that it refuses, they are joined by an impulse as those of a rope are (mbd/events/blow.h).
#pragma once

#include "mbd/system/one_sided_row.h"

namespace steplap {

class OneWayLock : public FrictionElement {
public:
  static constexpr double k_without_bound = 1e30; ///< N or N m: no machine bears as much

  int blow = 0; ///< slots of the memory: size of the last impulse, N s or N m s; energy lost in all of them, J

  /// Sign of the rate that it refuses whatever it takes; 0: what it holds has a bound either way.
  [[nodiscard]] virtual int refuses() const = 0;
  /// N or N m: what it holds the way that it lets go.
  [[nodiscard]] virtual double drag() const = 0;
};

/// Null where a friction element is none, or one whose bounds are finite.
[[nodiscard]] inline const OneWayLock* one_way_lock(const FrictionElement& friction) {
  if (friction.dimension() != 1 || friction.never_slips()) return nullptr;
  const auto* const lock = dynamic_cast<const OneWayLock*>(&friction);
  return lock && lock->refuses() != 0 ? lock : nullptr;
}

/// Of what takes blows, the first slot of the memory in which it notes them: impulse, and behind it the energy lost; −1 if it takes none.
[[nodiscard]] inline int blow_slot(const FrictionElement& friction) {
  if (const OneSidedRow* rope = one_sided_row(friction)) return rope->blow;
  const OneWayLock* const lock = one_way_lock(friction);
  return lock ? lock->blow : -1;
}

} // namespace steplap
