// To what values and rates of measures are known: sums of a few terms, each rounded.
//
// A gap of a picometre between bodies a kilometre from the origin is none. What a mode of an element hangs on is compared with
// these, so that it does not hang on the last bits of where the bodies are.
#pragma once

#include "mbd/system/measure.h"

#include <cmath>
#include <limits>

namespace steplap {

/// A place or a velocity comes out of a few turns of axes and sums, each of which rounds terms as large as these.
inline constexpr double k_rounded_sum = 32.0 * std::numeric_limits<double>::epsilon();

/// m, rad, m/s, rad/s: what joints hold at zero is known no better. Ten times what projection leaves of them
/// (SimulationSettings::projection_tolerance as it is if nobody sets it), for levers longer than between the joints.
inline constexpr double k_met = 1e-11;

namespace rounding {

template <class S> [[nodiscard]] S size(const Pair<S>& p) {
  using std::abs;
  return abs(p.x) + abs(p.y);
}

} // namespace rounding

/// Of a measure's value, `m` taken at these motions or in a link's frame. An angle that is off moves the end of its lever.
template <class S> [[nodiscard]] S value_rounding(const MeasureValue<S>& m, const Motion<S>& a, const Motion<S>& b) {
  using rounding::size;
  using std::abs;
  const S turned_a = abs(a.theta), turned_b = abs(b.theta);
  const S places = abs(a.x) + abs(a.y) + abs(b.x) + abs(b.y);
  const S levers = size(m.lever_a) * (S(1.0) + turned_a) + size(m.lever_b) * (S(1.0) + turned_b);
  return S(k_rounded_sum) * (size(m.direction) * (places + levers) + abs(m.couple) * (turned_a + turned_b) + abs(m.value));
}

/// The same of its rate.
template <class S> [[nodiscard]] S rate_rounding(const MeasureValue<S>& m, const Motion<S>& a, const Motion<S>& b) {
  using rounding::size;
  using std::abs;
  const S spin_a = abs(a.omega), spin_b = abs(b.omega);
  const S speeds = abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy) + size(m.lever_a) * spin_a + size(m.lever_b) * spin_b;
  return S(k_rounded_sum) * (size(m.direction) * speeds + abs(m.couple) * (spin_a + spin_b));
}

} // namespace steplap
