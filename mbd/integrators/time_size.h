// To what size of time a step's length is compared, where it is asked whether rounding leaves any of it: t, and near zero a
// little of the time in which the scene moves.
#pragma once

#include "mbd/system/scene_units.h"

#include <algorithm>
#include <cmath>

namespace steplap {

[[nodiscard]] inline double time_size(double t, const SceneUnits& scale) {
  constexpr double k_least_share = 3e-3; // 1 ms for bodies of a metre
  return std::max(std::abs(t), k_least_share * scale.time());
}

} // namespace steplap
