// Friction along one line whose force lies between two equal bounds: what all elements of that kind have in common.
#pragma once

#include "mbd/system/roles.h"

#include <algorithm>
#include <cmath>

namespace steplap {

// λ may pass the bound by rounding, relative: ten times below the 1e-12 that a load can resolve.
inline constexpr double k_friction_bound_slack = 1e-13;

/// FrictionElement::watch_stick() of |λ| ≤ bound, N or N m.
template <class S> void watch_bounds(const S& bound, const S& wrench, S* watch) {
  const S most = bound * (1.0 + k_friction_bound_slack);
  watch[0] = most - wrench;
  watch[1] = most + wrench;
}

/// FrictionElement::solve_block() of |λ| ≤ bound: min ½ a λ² + b λ.
[[nodiscard]] inline FrictionBlock block_within(double bound, double a, double b) {
  constexpr double k_no_motion = 1e-12; // m/s or m/s²: rounding of a coordinate that a drive keeps at rest
  FrictionBlock block;
  const double wanted = a > 0.0 ? -b / a : (b > 0.0 ? -bound : bound);
  // Where a drive prescribes the coordinate no force changes its motion: it rests or it does not.
  block.is_inside = a > 0.0 ? std::abs(wanted) <= bound * (1.0 + k_friction_bound_slack) : std::abs(b) <= k_no_motion;
  block.wrench[0] = std::clamp(wanted, -bound, bound);
  block.direction[0] = wanted > 0.0 ? -1.0 : 1.0;
  return block;
}

} // namespace steplap
