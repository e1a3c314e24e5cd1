// Characteristic rate of a scene, the scale for "slow" and "short": the rate at which its bodies fall by their own length.
//
// Without gravity no such rate is known before the run, so the rate of bodies of 1 m under gravity is used; scenes without gravity
// therefore do not scale with time. The duration of the run is not suitable as a scale: it would make short runs of stiff joints too
// coarse, and change the ends of slips in long ones.
#pragma once

#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>

namespace steplap {

inline constexpr double k_metre_rate = 3.1320919526731650; ///< 1/s: √(9.81 m/s² / 1 m)

/// Returns the characteristic rate, 1/s.
[[nodiscard]] inline double scene_rate(const System& system) { return system.gravity.isZero(0.0) ? k_metre_rate : system.scale.rate; }

/// Returns the time, s, to which a step length is compared to decide whether the step is only rounding: |t|, but at least a small
/// fraction of the characteristic time.
[[nodiscard]] inline double rounding_time_scale(double t, const System& system) {
  constexpr double k_least_share = 3.132e-3; // fraction of the characteristic time: 1 ms for bodies of 1 m
  return std::max(std::abs(t), k_least_share / scene_rate(system));
}

} // namespace steplap
