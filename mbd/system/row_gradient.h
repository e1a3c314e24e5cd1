// The gradient of a row: J of (27), what a unit multiplier does to the place and angle of either body.
//
// evaluate_row() of row.h is the only place that tells measures apart. Whoever wants a gradient takes it from the functions
// below, with numbers of any kind: doubles in an evaluation, Traced where an evaluation is written down (traced.h), Dual where
// it is differentiated (dual.h).
//
//   J_a = ( d,  r_a × d + couple),   J_b = −( d,  r_b × d + couple)
// with d the direction of the measure and r the way to its point from the centre that the coordinates belong to: that of the
// body, or of the cluster that the body rides on.
#pragma once

#include "mbd/system/row.h"

namespace steplap {

/// Three numbers of one side (0: a, 1: b); `lever`: r.
template <class S> STEPLAP_INLINE void put_gradient(const MeasureValue<S>& m, int side, const Pair<S>& lever, S* j) {
  const S couple = cross(lever, m.direction) + m.couple;
  j[0] = side == 0 ? m.direction.x : -m.direction.x;
  j[1] = side == 0 ? m.direction.y : -m.direction.y;
  j[2] = side == 0 ? couple : -couple;
}

template <class S> struct RowGradient {
  S j[6]; ///< by x, y, θ of a, then of b
  [[nodiscard]] const S* side(int s) const { return j + 3 * s; }
};

template <class S> [[nodiscard]] STEPLAP_INLINE RowGradient<S> gradient_of(const MeasureValue<S>& m) {
  RowGradient<S> g;
  put_gradient(m, 0, m.lever_a, g.j);
  put_gradient(m, 1, m.lever_b, g.j + 3);
  return g;
}

/// Of a row of two bodies, or of one part of a longer row.
template <class S> [[nodiscard]] RowGradient<S> row_gradient(const RowSpec& part, const Motion<S>& a, const Motion<S>& b) {
  return gradient_of(evaluate_row<false>(part, a, b));
}

} // namespace steplap
