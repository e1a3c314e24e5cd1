// Velocities between two bodies that count as rest.
#pragma once

#include "mbd/system/row.h"

#include <cmath>

namespace steplap {

/// m/s: far above the rounding of a projected velocity, far below any motion.
inline constexpr double k_rest_velocity = 1e-12;
/// Of the velocities that make up a relative one: what the instant of an event and projection leave of zero.
inline constexpr double k_rest_share = 1e-9;

/// Velocity of a body's point, with what it turns by.
inline double point_speed(const Motion<double>& m, const Pair<double>& lever, double couple) {
  return std::abs(m.vx - m.omega * lever.y) + std::abs(m.vy + m.omega * lever.x) + std::abs(couple * m.omega);
}

/// A rate of `row`, measured as `m`, that is none.
inline double rest_rate(const RowSpec& row, const MeasureValue<double>& m, const Motion<double>* motion) {
  return k_rest_velocity +
         k_rest_share * (point_speed(motion[row.a], m.lever_a, m.couple) + point_speed(motion[row.b], m.lever_b, m.couple));
}

} // namespace steplap
