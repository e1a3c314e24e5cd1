// Bounds of the rounding errors of measures.
//
// A gap of a picometre between bodies a kilometre from the origin is only rounding. Decisions about modes compare with these bounds, so
// that they do not depend on the last bits of positions.
#pragma once

#include "mbd/system/measure.h"

#include <cmath>
#include <limits>

namespace steplap {

/// Relative rounding error of a measure. Positions and velocities result from a few rotations and sums of terms; each operation rounds a
/// term.
inline constexpr double k_rounded_sum = 32.0 * std::numeric_limits<double>::epsilon();

/// Residual of joints, m, rad, m/s, rad/s: values below it count as zero. It is ten times the default residual after projection
/// (SimulationSettings::projection_tolerance), to allow for levers longer than the distances between joints.
inline constexpr double k_met = 1e-11;

namespace rounding {

template <class S> [[nodiscard]] S size(const Pair<S>& p) {
  using std::abs;
  return abs(p.x) + abs(p.y);
}

} // namespace rounding

/// Returns a bound of the rounding error of a measure's value. An error of an angle displaces the end of a lever. `m` may be relative to a
/// link's frame.
template <class S> [[nodiscard]] S value_rounding(const MeasureValue<S>& m, const Motion<S>& a, const Motion<S>& b) {
  using rounding::size;
  using std::abs;
  const S turned_a = abs(a.theta), turned_b = abs(b.theta);
  const S places = abs(a.x) + abs(a.y) + abs(b.x) + abs(b.y);
  const S levers = size(m.lever_a) * (S(1.0) + turned_a) + size(m.lever_b) * (S(1.0) + turned_b);
  return S(k_rounded_sum) * (size(m.direction) * (places + levers) + abs(m.couple) * (turned_a + turned_b) + abs(m.value));
}

/// Returns a bound of the rounding error of a measure's rate.
template <class S> [[nodiscard]] S rate_rounding(const MeasureValue<S>& m, const Motion<S>& a, const Motion<S>& b) {
  using rounding::size;
  using std::abs;
  const S spin_a = abs(a.omega), spin_b = abs(b.omega);
  const S speeds = abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy) + size(m.lever_a) * spin_a + size(m.lever_b) * spin_b;
  return S(k_rounded_sum) * (size(m.direction) * speeds + abs(m.couple) * (spin_a + spin_b));
}

} // namespace steplap
