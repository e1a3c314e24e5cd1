// Accuracy limits of positions, velocities and forces that no tolerance or step removes: projection meets constraints only to its own
// tolerance, and positions, velocities and times are rounded. If nothing moves, these are the only differences between two runs.
//
// A position error ε changes the force of a spring of stiffness k by k ε, and makes a mass m on it oscillate at velocity ε √(k/m). A
// velocity error ε changes the force of a damper c by c ε.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Each value is that of the body for which it is largest.
struct KnownTo {
  double rate = 0.0;  ///< m/s
  double force = 0.0; ///< N: sum over all elements that act on the body
};

/// Returns the accuracy limits. `met`: accuracy of constraints in m or rad, and m/s or rad/s (SimulationSettings::projection_tolerance).
/// `scratch` is overwritten.
[[nodiscard]] KnownTo known_to(const System& system, const Snapshot& s, double met, std::vector<PairJacobian>& scratch);

/// Returns the accuracy of positions, m: the largest over all bodies.
[[nodiscard]] double places_known_to(const System& system, const Snapshot& s, double met);

/// Returns the accuracy of the velocity along a row, m/s.
[[nodiscard]] double row_rate_known_to(const RowSpec& row, const Snapshot& s, double met);

} // namespace steplap
