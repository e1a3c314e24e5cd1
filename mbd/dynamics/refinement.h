// Iterative refinement of linear solutions near singular positions (SchurSolver, Mechanism).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

/// Repeats x += A⁻¹ (right − A x), n numbers, while each correction is less than half of the one before, at most four times.
/// find_correction(x) returns the correction. It must evaluate A x by the factors of A = J W Jᵀ one after the other, so that its rounding
/// errors are those of J and not those of A.
template <class FindCorrection> void refine_solution(int n, double* x, const FindCorrection& find_correction) {
  constexpr int k_max_refinements = 4;
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < k_max_refinements; ++iteration) {
    const double* const correction = find_correction(x);
    double size = 0.0, scale = 0.0;
    for (int r = 0; r < n; ++r) {
      size = std::max(size, std::abs(correction[r]));
      scale = std::max(scale, std::abs(x[r]));
    }
    if (!(size < 0.5 * previous)) return;
    for (int r = 0; r < n; ++r) x[r] += correction[r];
    if (size <= std::numeric_limits<double>::epsilon() * scale) return;
    previous = size;
  }
}

} // namespace steplap
