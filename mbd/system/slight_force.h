// Threshold below which a force in a row is negligible, for rows without a friction bound that could serve as a scale.
#pragma once

#include "mbd/system/system.h"

#include <algorithm>
#include <limits>

namespace steplap {

/// Returns 1e-6 of the force (N, for an angle N m) that gives the lighter of the row's bodies the characteristic acceleration of the
/// system. Precondition: at least one body of `row` moves.
[[nodiscard]] inline double slight_force(const System& system, const RowSpec& row) {
  constexpr double k_slight = 1e-6;
  double lightest = std::numeric_limits<double>::infinity();
  for (const int index : {row.a, row.b}) {
    if (index == k_ground) continue;
    const BodyData& body = system.bodies[static_cast<std::size_t>(index)];
    lightest = std::min(lightest, row.kind == MeasureKind::angle ? body.inertia : body.mass * system.scale.length);
  }
  return k_slight * lightest * system.scale.rate * system.scale.rate;
}

} // namespace steplap
