// Gradient of a row: J of (27), the generalised force on both bodies for a unit multiplier.
//
//   J_a = ( d,  r_a × d + couple),   J_b = −( d,  r_b × d + couple)
//
// d is the direction of the measure, r the vector to its point of application from the reference point of the coordinates: the centre of
// gravity of the body, or of its cluster. Only evaluate_row() (row.h) distinguishes measures; the functions here apply to all of them and
// to all number types: double, Traced (traced.h) and Dual (dual.h).
#pragma once

#include "mbd/system/row.h"

namespace steplap {

/// Writes the three components of the gradient for side 0 (a) or 1 (b) to j; `lever` is r.
template <class S> STEPLAP_INLINE void put_gradient(const MeasureValue<S>& m, int side, const Pair<S>& lever, S* j) {
  const S couple = cross(lever, m.direction) + m.couple;
  j[0] = side == 0 ? m.direction.x : -m.direction.x;
  j[1] = side == 0 ? m.direction.y : -m.direction.y;
  j[2] = side == 0 ? couple : -couple;
}

template <class S> struct RowGradient {
  S j[6]; ///< derivatives by x, y, θ of a, then of b
  [[nodiscard]] const S* side(int s) const { return j + 3 * s; }
};

template <class S> [[nodiscard]] STEPLAP_INLINE RowGradient<S> gradient_of(const MeasureValue<S>& m) {
  RowGradient<S> g;
  put_gradient(m, 0, m.lever_a, g.j);
  put_gradient(m, 1, m.lever_b, g.j + 3);
  return g;
}

/// Returns the gradient of a row of two bodies, or of one part of a longer row.
template <class S> [[nodiscard]] RowGradient<S> row_gradient(const RowSpec& part, const Motion<S>& a, const Motion<S>& b) {
  return gradient_of(evaluate_row<false>(part, a, b));
}

} // namespace steplap
