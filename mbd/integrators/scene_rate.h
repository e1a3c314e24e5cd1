// The rate and the time that what is small in a scene is measured by: those with which its bodies fall over their own length.
//
// Without gravity nothing tells such a rate before the run: what bodies of a metre have is taken, whatever they are, and scenes
// without gravity whose times are scaled are not stepped alike. The run's duration does not serve: short runs of stiff joints
// become too coarse by it, and long ones let slips end otherwise.
#pragma once

#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>

namespace steplap {

inline constexpr double k_metre_rate = 3.1320919526731650; ///< 1/s: √(9.81 m/s² / 1 m)

/// 1/s.
[[nodiscard]] inline double scene_rate(const System& system) { return system.gravity.isZero(0.0) ? k_metre_rate : system.scale.rate; }

/// To what size of time a step's length is compared, where it is asked whether rounding leaves any of it: t, and near zero a
/// little of the time in which the scene moves.
[[nodiscard]] inline double time_size(double t, const System& system) {
  constexpr double k_least_share = 3.132e-3; // 1 ms for bodies of a metre
  return std::max(std::abs(t), k_least_share / scene_rate(system));
}

} // namespace steplap
