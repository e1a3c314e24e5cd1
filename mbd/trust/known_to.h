// Accuracy limits of positions, velocities and forces that no tolerance and no step can improve: projection satisfies constraints only to
// its own tolerance, and positions, velocities and times are rounded. If nothing moves, two runs differ only by this.
//
// A position error ε changes the force of a spring of stiffness k by k ε, and makes a mass m on it oscillate with velocity ε √(k/m). A
// velocity error ε changes the force of a damper c by c ε.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Accuracy limits of a system: each member is that of the body for which it is largest.
struct MotionAccuracy {
  double rate = 0.0;  ///< m/s
  double force = 0.0; ///< N; sum over all elements that act on the body
};

/// Returns the accuracy limits at `s`. `met`: accuracy to which constraints are satisfied, m or rad, and m/s or rad/s
/// (SimulationSettings::projection_tolerance). `scratch` is overwritten.
[[nodiscard]] MotionAccuracy known_to(const System& system, const Snapshot& s, double met, std::vector<PairJacobian>& scratch);

/// Returns the accuracy of positions, m: that of the body for which it is largest.
[[nodiscard]] double position_accuracy(const System& system, const Snapshot& s, double met);

/// Returns the accuracy of the velocity along a row, m/s.
[[nodiscard]] double row_rate_known_to(const RowSpec& row, const Snapshot& s, double met);

} // namespace steplap
