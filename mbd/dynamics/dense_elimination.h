// Factorisation of small dense symmetric matrices, for doubles or recorded numbers (mbd/tape).
#pragma once

#include "mbd/system/motion.h"

namespace steplap {

/// Factorises m = L D Lᵀ in place, row by row; below the diagonal m contains L D first, then L. raise(diagonal) returns the diagonal with
/// damping. invert(i, d, diagonal) returns 1/d, or 0 if row i is to be left out. N is the number of rows if it is known at compile time
/// (loops are then unrolled), otherwise 0.
template <int N, class S, class Raise, class Invert>
STEPLAP_INLINE void eliminate_rows(S* m, S* inverse_d, int count, const Raise& raise, const Invert& invert) {
  const int n = N > 0 ? N : count;
  for (int i = 0; i < n; ++i) {
    S* const mi = m + i * n;
    const S diagonal = raise(mi[i]);
    S d = diagonal;
    for (int j = 0; j < i; ++j) {
      S sum = mi[j];
      for (int k = 0; k < j; ++k) sum -= mi[k] * m[j * n + k];
      mi[j] = sum;
    }
    for (int j = 0; j < i; ++j) {
      const S l = mi[j] * inverse_d[j];
      d -= l * mi[j];
      mi[j] = l;
    }
    inverse_d[i] = invert(i, d, diagonal);
  }
}

/// Solves L D Lᵀ x = x₀ in place.
template <int N, class S> STEPLAP_INLINE void substitute(const S* m, const S* inverse_d, int count, S* x) {
  const int n = N > 0 ? N : count;
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) x[i] -= m[i * n + j] * x[j];
  for (int i = 0; i < n; ++i) x[i] *= inverse_d[i];
  for (int i = n - 1; i > 0; --i)
    for (int j = 0; j < i; ++j) x[j] -= m[i * n + j] * x[i];
}

} // namespace steplap
