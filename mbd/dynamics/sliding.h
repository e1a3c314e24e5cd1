// What friction that slides does to the bodies of its rows: on doubles, or on numbers that are written down (mbd/tape).
#pragma once

#include "mbd/system/roles.h"

namespace steplap {

/// The rows of a friction element, one or three, and the velocities at which it slides along them.
template <class S> struct SlidingRows {
  int count = 0;
  MeasureValue<S> measure[3];
  S rate[3];

  /// `motion` of the rows' body a, seen from b.
  STEPLAP_INLINE SlidingRows(const RowSpec* rows, int count_, const Motion<S>& motion) : count(count_) {
    for (int r = 0; r < count; ++r) {
      measure[r] = evaluate_row<false>(rows[r], motion, Origin{});
      rate[r] = measure[r].rate;
    }
  }
  /// The wrench of the slip law acts on the link and dissipates −w·rate.
  STEPLAP_INLINE void pull(const S* wrench, BodyForceOf<S>& link_force, S& dissipation) const {
    for (int r = 0; r < count; ++r) {
      apply_force(link_force, measure[r], wrench[r]);
      dissipation -= wrench[r] * rate[r];
    }
  }
};

} // namespace steplap
