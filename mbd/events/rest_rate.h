// Limit below which a relative velocity of two bodies counts as zero.
#pragma once

#include "mbd/system/row.h"

#include <cmath>

namespace steplap {

/// Absolute part of the limit, m/s: far above the rounding error of a projected velocity, far below any motion of interest.
inline constexpr double k_rest_velocity = 1e-12;
/// Relative part: fraction of the velocities whose difference is the relative velocity. It covers the errors of the event time and of the
/// projection.
inline constexpr double k_rest_share = 1e-9;

/// Returns the speed of a point of a body, m/s: translation plus rotation about `lever`, plus |omega couple|.
inline double point_speed(const Motion<double>& m, const Pair<double>& lever, double couple) {
  return std::abs(m.vx - m.omega * lever.y) + std::abs(m.vy + m.omega * lever.x) + std::abs(couple * m.omega);
}

/// Returns the limit of rest for the rate of `row`, m/s or rad/s. `m`: value, rate and levers of the row.
inline double rest_rate(const RowSpec& row, const MeasureValue<double>& m, const Motion<double>* motion) {
  return k_rest_velocity +
         k_rest_share * (point_speed(motion[row.a], m.lever_a, m.couple) + point_speed(motion[row.b], m.lever_b, m.couple));
}

} // namespace steplap
