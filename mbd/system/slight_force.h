// What is slight for the bodies that a row joins, where nothing else tells: a bound that is zero, or none.
#pragma once

#include "mbd/system/system.h"

#include <algorithm>
#include <limits>

namespace steplap {

/// N, of an angle N m: a millionth of what gives the lighter of the row's bodies the scene's acceleration. `row`: of a body that moves.
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
