// Iterative refinement of a solution near a singular position (SchurSolver, Mechanism).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

/// x += A⁻¹ (right − A x), n numbers, while that makes the correction less than half as large as the one before.
/// `find_correction(x)` gives the n numbers of it, found factor by factor, so that its rounding is that of A's factors.
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
