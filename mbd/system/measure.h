// Measures: scalar functions of the relative pose of two bodies a and b, with gradient and second rate.
//
// Nearly everything planar is a law or a constraint on one of five scalars: the distance of a marker
// along an axis of b, the distance of two points, a relative angle, the gap of a contact and the
// tangential coordinate of its tip. What a skate forbids is a sixth, of which there is only the rate. A measure gives
//   value, rate,
//   the gradient as a unit wrench: direction d at a common point of both bodies plus a couple, acting on
//   a, its opposite on b (Newton's third law holds by construction),
//   bias = second time derivative at zero accelerations (q̇ᵀ f_qq q̇; γ of physics.md §1 is −bias).
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/motion.h"

namespace steplap {

template <class S> struct MeasureValue {
  S value{0}, rate{0}, bias{0};
  Pair<S> direction;        ///< of the force on a, ground axes
  Pair<S> lever_a, lever_b; ///< from each centre of gravity to the point of application
  S couple{0};              ///< on a; its opposite on b
};

/// e·(p_A − p_B) with e fixed in b: force e at p_A.
///
/// With r the vector from b's centre of gravity to p_A, e·(p_A − p_B) = e·r − e·point_b, and the last
/// term is a constant of b's frame.
struct AxisMeasure {
  Vec2 point_a, point_b, axis; ///< in the frames of a, b, b
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a);
    const Pair<S> e = to_ground(b, axis);
    const Pair<S> reach = offset(a, b) + ra;
    const Pair<S> velocity = point_velocity(a, ra) - point_velocity(b, reach); // seen from b
    m.value = dot(e, reach) - S(axis.dot(point_b));
    m.direction = e;
    m.lever_a = ra;
    m.lever_b = reach;
    m.rate = dot(e, velocity);
    if constexpr (WithBias) { // relative acceleration in b's turning frame, accelerations zero
      m.bias = -(a.omega * a.omega * dot(e, ra));
      if constexpr (!k_is_origin<B>) m.bias += b.omega * b.omega * dot(e, reach) - S(2) * b.omega * cross(velocity, e);
    }
    return m;
  }
};

/// Value and rate of a coordinate in the link's frame: half of its gradient is zero.
template <int K, class S> struct CoordinateValue {
  S value{0}, rate{0};
  Pair<S> lever_a;
};

/// The same along b's own x axis (K = 0) or y axis (K = 1), as most supports and blocks are: seen from b
/// the direction never turns, and only one coordinate counts.
template <int K> struct CoordinateMeasure {
  Vec2 point_a, point_b;
  [[nodiscard]] AxisMeasure along_axis() const { return {point_a, point_b, Vec2::Unit(K)}; }
  template <bool WithBias, class S> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const Motion<S>& b) const {
    return along_axis().template at<WithBias, S>(a, b);
  }
  template <bool WithBias, class S> STEPLAP_INLINE CoordinateValue<K, S> at(const Motion<S>& a, Origin) const {
    static_assert(!WithBias, "rows take AxisMeasure");
    CoordinateValue<K, S> m;
    m.lever_a = to_ground(a, point_a);
    m.value = K == 0 ? a.x + m.lever_a.x - point_b.x() : a.y + m.lever_a.y - point_b.y();
    m.rate = K == 0 ? a.vx - a.omega * m.lever_a.y : a.vy + a.omega * m.lever_a.x;
    return m;
  }
};

/// Calls f with the cheapest measure that does the same.
template <class F> void with_cheapest(const AxisMeasure& m, F&& f) {
  if (m.axis == Vec2(1.0, 0.0)) f(CoordinateMeasure<0>{m.point_a, m.point_b});
  else if (m.axis == Vec2(0.0, 1.0)) f(CoordinateMeasure<1>{m.point_a, m.point_b});
  else f(m);
}

/// |p_A − p_B|; undefined at zero length (the rate then is not finite, and the caller says so).
struct DistanceMeasure {
  Vec2 point_a, point_b;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    using std::sqrt;
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), rb = to_ground(b, point_b);
    const Pair<S> d = offset(a, b) + ra - rb;
    const Pair<S> ddot = point_velocity(a, ra) - point_velocity(b, rb);
    m.value = sqrt(dot(d, d));
    m.direction = (S(1) / m.value) * d;
    m.lever_a = ra;
    m.lever_b = rb;
    m.rate = dot(m.direction, ddot);
    if constexpr (WithBias) {
      m.bias = (dot(ddot, ddot) - m.rate * m.rate) / m.value - a.omega * a.omega * dot(m.direction, ra);
      if constexpr (!k_is_origin<B>) m.bias += b.omega * b.omega * dot(m.direction, rb);
    }
    return m;
  }
};

/// θ_A − θ_B.
struct AngleMeasure {
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m;
    m.value = relative_angle(a, b);
    m.rate = relative_spin(a, b);
    m.couple = S(1);
    return m;
  }
};

/// Gap of a contact, δ = n·(p_A − p_B)/(n·a): force n/(n·a) at the tip p_A − δ a (physics.md §2). With
/// the axis n itself this is the ordinary distance from b's line. n·a > 0 is required.
struct GapMeasure {
  Vec2 point_a, point_b, normal; ///< in the frames of a, b, b
  Vec2 axis = Vec2::Zero();      ///< in the frame of a, if is_axis_in_a
  bool is_axis_in_a = false;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    // n through p_A and n through the tip act along the same line: the plain gap is an axis measure.
    if (!is_axis_in_a) return AxisMeasure{point_a, point_b, normal}.at<WithBias, S>(a, b);
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), n = to_ground(b, normal), shaft = to_ground(a, axis);
    const Pair<S> reach = offset(a, b) + ra; // from b's centre to p_A
    const S inverse_alpha = S(1) / dot(n, shaft);
    m.value = (dot(n, reach) - S(normal.dot(point_b))) * inverse_alpha;
    const Pair<S> back = m.value * shaft;
    m.direction = inverse_alpha * n;
    m.lever_a = ra - back;
    m.lever_b = reach - back;
    const Pair<S> velocity = point_velocity(a, m.lever_a) - point_velocity(b, m.lever_b);
    m.rate = dot(m.direction, velocity);
    if constexpr (WithBias) {
      // n·(p_A − p_B) = δ α differentiated twice, α' = β Ω, α'' = −α Ω² with β = t·a
      const S beta = cross(shaft, n); // t·a, t = (n_y, −n_x)
      const S spin = relative_spin(a, b);
      S second = -(a.omega * a.omega * dot(n, ra));
      if constexpr (!k_is_origin<B>) {
        const Pair<S> seen = point_velocity(a, ra) - point_velocity(b, reach);
        second += b.omega * b.omega * dot(n, reach) - S(2) * b.omega * cross(seen, n);
      }
      m.bias = (second - S(2) * m.rate * beta * spin) * inverse_alpha + m.value * spin * spin;
    }
    return m;
  }
};

/// Tangential coordinate of the same tip on b's line, s = t·(p_A − δ a − p_B) = (d × a)/(n·a), d = p_A −
/// p_B; with the axis a = body a's y axis it equals Eq. (8). Its gradient is −ẑ×a/(n·a) at the tip. With
/// the axis n itself it is t·(p_A − p_B), held at p_A.
struct SlideMeasure {
  Vec2 point_a, point_b, normal;
  Vec2 axis = Vec2::Zero();
  bool is_axis_in_a = false;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    if (!is_axis_in_a) return AxisMeasure{point_a, point_b, Vec2(normal.y(), -normal.x())}.at<WithBias, S>(a, b);
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), rb = to_ground(b, point_b);
    const Pair<S> n = to_ground(b, normal), shaft = to_ground(a, axis);
    const Pair<S> reach = offset(a, b) + ra; // from b's centre to p_A
    const Pair<S> d = reach - rb;
    const S inverse_alpha = S(1) / dot(n, shaft);
    const S turned = cross(d, shaft);
    m.value = turned * inverse_alpha;
    m.direction = {shaft.y * inverse_alpha, -shaft.x * inverse_alpha};
    const Pair<S> back = dot(n, d) * inverse_alpha * shaft; // δ a
    m.lever_a = ra - back;
    m.lever_b = reach - back;
    m.rate = dot(m.direction, point_velocity(a, m.lever_a) - point_velocity(b, m.lever_b));
    if constexpr (WithBias) {
      // s α = d × a twice differentiated, with ȧ = ωA ẑ×a and α' = β Ω, α'' = −α Ω², β = t·a
      const S wa2 = a.omega * a.omega;
      const Pair<S> velocity = point_velocity(a, ra) - point_velocity(b, rb);
      S second = S(2) * a.omega * dot(velocity, shaft) - wa2 * (cross(ra, shaft) + turned);
      if constexpr (!k_is_origin<B>) second += b.omega * b.omega * cross(rb, shaft);
      const S spin = relative_spin(a, b);
      m.bias = (second - S(2) * m.rate * cross(shaft, n) * spin) * inverse_alpha + m.value * spin * spin;
    }
    return m;
  }
};

/// Rolling of a circle of a on a line of b: t·(p_A − p_B) + r (θ_A − θ_B), p_A the circle's centre, n the
/// line's normal towards it, t = (n_y, −n_x). Its rate is the velocity of a's material point at p_A − r n
/// along t; so it is a rack's constraint too. A negative r is a circle on the line's other side.
struct RollLineMeasure {
  Vec2 point_a, point_b, normal; ///< in the frames of a, b, b
  double radius = 0.0;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m = AxisMeasure{point_a, point_b, Vec2(normal.y(), -normal.x())}.at<WithBias, S>(a, b);
    m.value += S(radius) * relative_angle(a, b);
    m.rate += S(radius) * relative_spin(a, b);
    m.couple = S(radius);
    return m;
  }
};

/// Rolling of a circle of a on a circle of b: r_A (θ_A − θ_B) − (r_A + r_B) φ, φ the angle of p_A − p_B
/// (their centres) in b's frame, counted from `start`. Holonomic, and exact for two gears; for circles that
/// are pressed together by δ both radii count as reduced by the factor 1 − δ/(r_A + r_B), so that the force,
/// which is across the line of centres, acts at one point of both. r_A negative: a rolls inside b's ring.
/// φ jumps by 2π opposite to `start`: compare values with off_target (row.h).
struct RollRoundMeasure {
  Vec2 point_a, point_b, start; ///< in the frames of a, b, b
  double radius_a = 0.0, radius_b = 0.0;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    using portable::atan2;
    using std::sqrt;
    MeasureValue<S> m;
    const S reach(radius_a + radius_b);
    const Pair<S> ra = to_ground(a, point_a), rb = to_ground(b, point_b), zero = to_ground(b, start);
    const Pair<S> d = offset(a, b) + ra - rb;
    const S length = sqrt(dot(d, d)), inverse = S(1) / length;
    const Pair<S> n = inverse * d;
    m.value = S(radius_a) * relative_angle(a, b) - reach * atan2(cross(zero, d), dot(zero, d));
    m.direction = (-(reach * inverse)) * perp(n);
    const Pair<S> arm = (S(radius_a / (radius_a + radius_b)) * length) * n; // from the contact to p_A
    m.lever_a = ra - arm;
    m.lever_b = rb + d - arm;
    m.rate = dot(m.direction, point_velocity(a, m.lever_a) - point_velocity(b, m.lever_b));
    if constexpr (WithBias) {
      // φ'' = (e·d'' − 2 d' φ')/d with e across d and d'' at zero accelerations
      const Pair<S> across = perp(n), ddot = point_velocity(a, ra) - point_velocity(b, rb);
      S second = -(a.omega * a.omega * dot(across, ra));
      if constexpr (!k_is_origin<B>) second += b.omega * b.omega * dot(across, rb);
      m.bias = -(reach * inverse) * (second - S(2) * inverse * dot(n, ddot) * dot(across, ddot));
    }
    return m;
  }
};

/// Sideways velocity of a skate of a on the plane of b: n·v, n fixed in a, v the velocity of p_A against the material point of b
/// that is there. It is the rate of no coordinate (no function of the pose has it for a derivative, since n turns with a): the
/// value is zero wherever the bodies are, and only velocities are held.
struct SkateMeasure {
  Vec2 point_a, normal; ///< in the frame of a
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), n = to_ground(a, normal);
    const Pair<S> reach = offset(a, b) + ra;
    const Pair<S> velocity = point_velocity(a, ra) - point_velocity(b, reach); // seen from b
    m.direction = n;
    m.lever_a = ra;
    m.lever_b = reach;
    m.rate = dot(n, velocity);
    if constexpr (WithBias) { // n·v differentiated at accelerations of zero, ṅ = ω_A ẑ×n
      m.bias = a.omega * cross(n, velocity) - a.omega * a.omega * dot(n, ra);
      if constexpr (!k_is_origin<B>) m.bias += b.omega * b.omega * dot(n, reach) - b.omega * cross(velocity, n);
    }
    return m;
  }
};

} // namespace steplap
