// To what a run knows places, velocities and forces, whatever its tolerance or step: projection leaves joints open by its own tolerance,
// and places, velocities and times are rounded. Where nothing moves nothing else is left, and two runs differ by it.
//
// A place that is off by ε changes the force of a spring of stiffness k by k ε, and lets a mass m on it swing with ε √(k/m). Damping c
// makes c ε of a velocity that is off by ε.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Each of the body that it is largest for.
struct KnownTo {
  double rate = 0.0;  ///< m/s
  double force = 0.0; ///< N: by all elements that act on the body
};

/// `met`: m or rad, and m/s or rad/s, to which constraints are met (SimulationSettings::projection_tolerance). `scratch` is overwritten.
[[nodiscard]] KnownTo known_to(const System& system, const Snapshot& s, double met, std::vector<PairJacobian>& scratch);

/// m: to which the place of any body is known.
[[nodiscard]] double places_known_to(const System& system, const Snapshot& s, double met);

/// m/s: to which the rate along a row is known.
[[nodiscard]] double row_rate_known_to(const RowSpec& row, const Snapshot& s, double met);

} // namespace steplap
