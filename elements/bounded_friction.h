// Functions for one-dimensional friction with a symmetric bound, |λ| ≤ bound.
#pragma once

#include "mbd/system/roles.h"

#include <algorithm>
#include <cmath>

namespace steplap {

// Relative tolerance of the bound for rounding errors of λ; ten times less than the 1e-12 to which a load is resolved.
inline constexpr double k_friction_bound_slack = 1e-13;

/// Event functions of sticking, FrictionElement::stick_events(): bound ± λ, N or N m.
template <class S> void bound_events(const S& bound, const S& wrench, S* event_value) {
  const S most = bound * (1.0 + k_friction_bound_slack);
  event_value[0] = most - wrench;
  event_value[1] = most + wrench;
}

/// Solves FrictionElement::solve_block(): minimises ½ a λ² + b λ for |λ| ≤ bound.
[[nodiscard]] inline BlockSolution block_within(double bound, double a, double b) {
  constexpr double k_no_motion = 1e-12; // m/s or m/s²: rounding error of a coordinate that a drive keeps at rest
  BlockSolution block;
  const double wanted = a > 0.0 ? -b / a : (b > 0.0 ? -bound : bound);
  // If a drive prescribes the coordinate (a = 0) friction does not affect the motion, and b alone decides.
  block.sticks = a > 0.0 ? std::abs(wanted) <= bound * (1.0 + k_friction_bound_slack) : std::abs(b) <= k_no_motion;
  block.wrench[0] = std::clamp(wanted, -bound, bound);
  block.direction[0] = wanted > 0.0 ? -1.0 : 1.0;
  return block;
}

} // namespace steplap
