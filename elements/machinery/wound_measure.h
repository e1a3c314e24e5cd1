// Elongation e of a rope between two wheels on which it is wound, or between a wheel and a point. Derivation: wound_rope.h.
#pragma once

#include "mbd/system/turn_table.h"

#include <cmath>

namespace steplap {

/// Measure with the value −e, so that a taut rope is a pressed contact. It uses ground axes, because θ may be many turns.
struct WoundMeasure {
  Vec2 point_a, point_b; ///< centres of the wheels
  double radius_a = 0.0, radius_b = 0.0;
  Vec2 start = Vec2::UnitX(); ///< direction u of the straight part in the reference pose, unit vector
  double taken = 0.0;         ///< value of e in the reference pose, m

  template <class S> struct Straight {
    Pair<S> u, lever_a, lever_b; ///< direction u; levers of the points at which the rope leaves the wheels
    S length{0};
  };
  template <class S> [[nodiscard]] Straight<S> straight(const Motion<S>& a, const Motion<S>& b) const {
    using std::sqrt;
    const Pair<S> centre_a = to_ground(a, point_a), centre_b = to_ground(b, point_b);
    const Pair<S> d = centre_b - centre_a - offset(a, b);
    const S c(radius_a + radius_b), square = dot(d, d), length = sqrt(square - c * c);
    const Pair<S> u = (S(1) / square) * (length * d - c * perp(d)), across = perp(u);
    return {u, centre_a + S(radius_a) * across, centre_b - S(radius_b) * across, length};
  }
  template <class S> [[nodiscard]] S turned(const Pair<S>& u) const {
    using portable::atan2;
    const Pair<S> from{S(start.x()), S(start.y())};
    return atan2(cross(from, u), dot(from, u));
  }
  template <bool WithBias, class S> [[nodiscard]] MeasureValue<S> at(const Motion<S>& a, const Motion<S>& b) const {
    static_assert(!WithBias, "no row takes it");
    return along(straight(a, b), a, b);
  }
  template <class S> [[nodiscard]] MeasureValue<S> along(const Straight<S>& part, const Motion<S>& a, const Motion<S>& b) const {
    const double c = radius_a + radius_b;
    MeasureValue<S> m;
    m.value = S(taken) - part.length - S(radius_a) * a.theta - S(radius_b) * b.theta;
    if (c != 0.0) m.value += S(c) * turned(part.u);
    m.direction = part.u;
    m.lever_a = part.lever_a;
    m.lever_b = part.lever_b;
    m.rate = dot(part.u, point_velocity(a, part.lever_a) - point_velocity(b, part.lever_b));
    return m;
  }
};

[[nodiscard]] inline Turning turning_of(const WoundMeasure& m) { return {moves_by_turning(m.point_a), moves_by_turning(m.point_b)}; }

/// Largest angle, rad, between the straight part and its direction in the reference pose; beyond π the angle would jump by a turn.
inline constexpr double k_most_turned = 3.0;

} // namespace steplap
