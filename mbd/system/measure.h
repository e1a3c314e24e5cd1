// Measures: scalar functions of the relative pose of two bodies a and b, with gradient and second derivative.
//
// Almost all planar force laws and constraints act on one of five measures: position of a point of a along an axis of b, distance of two
// points, relative angle, contact gap, and tangential coordinate of the contact point. Rolling and the skate are further ones. A measure
// provides
//
//   value, rate
//   gradient   as a unit wrench: direction d at a common point of both bodies plus a couple, acting on a, and its opposite on b, so that
//              Newton's third law is satisfied by construction
//   bias       second time derivative at zero accelerations, q̇ᵀ f_qq q̇ (γ of theory.md §1 is −bias)
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/motion.h"

namespace steplap {

template <class S> struct MeasureValue {
  S value{0}, rate{0}, bias{0};
  Pair<S> direction;        ///< direction of the force on a, ground axes
  Pair<S> lever_a, lever_b; ///< from each centre of gravity to the point of application, ground axes
  S couple{0};              ///< couple on a; the opposite acts on b
};

/// Value e·(p_A − p_B) with e fixed in b; gradient: unit force e at p_A. Computed as e·r − e·point_b, with r the vector from b's centre of
/// gravity to p_A; the second term is constant.
struct AxisMeasure {
  Vec2 point_a, point_b, axis; ///< in the frames of a, b and b
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
    if constexpr (WithBias) { // relative acceleration in b's rotating frame at zero accelerations
      m.bias = -(a.omega * a.omega * dot(e, ra));
      if constexpr (!k_is_origin<B>) m.bias += b.omega * b.omega * dot(e, reach) - S(2) * b.omega * cross(velocity, e);
    }
    return m;
  }
};

/// Result of CoordinateMeasure<K> for a link, whose motion is that of body a relative to body b. In the axes of b the direction of the
/// force is e_x or e_y. The reaction on b is added later for the whole link (add_link_force()), so a lever arm on b is not needed.
template <int K, class S> struct CoordinateValue {
  S value{0}, rate{0};
  Pair<S> lever_a;
};

/// AxisMeasure along b's own x axis (K = 0) or y axis (K = 1), as in most supports and blocks. In b's frame the direction is constant and
/// only one coordinate is needed, which is cheaper.
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

/// Calls f with a measure of the same value as m: a CoordinateMeasure if the axis is parallel to an axis of b, otherwise m.
template <class F> void with_cheapest(const AxisMeasure& m, F&& f) {
  if (m.axis == Vec2(1.0, 0.0)) f(CoordinateMeasure<0>{m.point_a, m.point_b});
  else if (m.axis == Vec2(0.0, 1.0)) f(CoordinateMeasure<1>{m.point_a, m.point_b});
  else f(m);
}

/// Value |p_A − p_B|. At zero length the rate is not finite; callers must check this.
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

/// Value θ_A − θ_B, rad.
struct AngleMeasure {
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m;
    m.value = relative_angle(a, b);
    m.rate = relative_spin(a, b);
    m.couple = S(1);
    return m;
  }
};

/// Gap of a contact, δ = n·(p_A − p_B)/(n·a); gradient: force n/(n·a) at the tip p_A − δ a (theory.md §2). If the contact axis a is the
/// normal n, δ is the distance from b's line. Precondition: n·a > 0.
struct GapMeasure {
  Vec2 point_a, point_b, normal; ///< in the frames of a, b and b
  Vec2 axis = Vec2::Zero();      ///< contact axis in the frame of a, if is_axis_in_a; otherwise the axis is `normal`
  bool is_axis_in_a = false;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    // Through p_A and through the tip a force along n has the same line of action, so the gap equals an AxisMeasure.
    if (!is_axis_in_a) return AxisMeasure{point_a, point_b, normal}.at<WithBias, S>(a, b);
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), n = to_ground(b, normal), shaft = to_ground(a, axis);
    const Pair<S> reach = offset(a, b) + ra; // from b's centre of gravity to p_A
    const S inverse_alpha = S(1) / dot(n, shaft);
    m.value = (dot(n, reach) - S(normal.dot(point_b))) * inverse_alpha;
    const Pair<S> back = m.value * shaft;
    m.direction = inverse_alpha * n;
    m.lever_a = ra - back;
    m.lever_b = reach - back;
    const Pair<S> velocity = point_velocity(a, m.lever_a) - point_velocity(b, m.lever_b);
    m.rate = dot(m.direction, velocity);
    if constexpr (WithBias) {
      // Second derivative of n·(p_A − p_B) = δ α, with α' = β Ω, α'' = −α Ω², β = t·a
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

/// Tangential coordinate of the contact tip on b's line, s = t·(p_A − δ a − p_B) = (d × a)/(n·a) with d = p_A − p_B; Eq. (8) if the axis a
/// is body a's y axis. Gradient: −ẑ×a/(n·a) at the tip. If a = n, s = t·(p_A − p_B) with the force at p_A.
struct SlideMeasure {
  Vec2 point_a, point_b, normal;
  Vec2 axis = Vec2::Zero();
  bool is_axis_in_a = false;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    if (!is_axis_in_a) return AxisMeasure{point_a, point_b, Vec2(normal.y(), -normal.x())}.at<WithBias, S>(a, b);
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), rb = to_ground(b, point_b);
    const Pair<S> n = to_ground(b, normal), shaft = to_ground(a, axis);
    const Pair<S> reach = offset(a, b) + ra; // from b's centre of gravity to p_A
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
      // Second derivative of s α = d × a, with ȧ = ωA ẑ×a, α' = β Ω, α'' = −α Ω², β = t·a
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

/// Rolling of a circle of a on a line of b: value t·(p_A − p_B) + r (θ_A − θ_B), with p_A the centre of the circle, n the normal of the
/// line towards it and t = (n_y, −n_x). The rate is the velocity along t of a's material point at p_A − r n; the measure therefore also
/// describes rack and pinion. Negative r: the circle is on the other side of the line.
struct RollLineMeasure {
  Vec2 point_a, point_b, normal; ///< in the frames of a, b and b
  double radius = 0.0;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m = AxisMeasure{point_a, point_b, Vec2(normal.y(), -normal.x())}.at<WithBias, S>(a, b);
    m.value += S(radius) * relative_angle(a, b);
    m.rate += S(radius) * relative_spin(a, b);
    m.couple = S(radius);
    return m;
  }
};

/// Rolling of a circle of a on a circle of b: value r_A (θ_A − θ_B) − (r_A + r_B) φ, with φ the angle of p_A − p_B (the centres) in b's
/// frame, measured from `start`. Exact for two gears. If the circles penetrate by δ, both radii are reduced by the factor 1 − δ/(r_A +
/// r_B), so that the tangential force acts at one common point. Negative r_A: a rolls inside a ring of b. φ jumps by 2π opposite to
/// `start`, so values must be compared by off_target() (row.h).
struct RollRoundMeasure {
  Vec2 point_a, point_b, start; ///< in the frames of a, b and b
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
    const Pair<S> arm = (S(radius_a / (radius_a + radius_b)) * length) * n; // from the contact point to p_A
    m.lever_a = ra - arm;
    m.lever_b = rb + d - arm;
    m.rate = dot(m.direction, point_velocity(a, m.lever_a) - point_velocity(b, m.lever_b));
    if constexpr (WithBias) {
      // φ'' = (e·d'' − 2 d' φ')/d, with e perpendicular to d and d'' at zero accelerations
      const Pair<S> across = perp(n), ddot = point_velocity(a, ra) - point_velocity(b, rb);
      S second = -(a.omega * a.omega * dot(across, ra));
      if constexpr (!k_is_origin<B>) second += b.omega * b.omega * dot(across, rb);
      m.bias = -(reach * inverse) * (second - S(2) * inverse * dot(n, ddot) * dot(across, ddot));
    }
    return m;
  }
};

/// Lateral velocity n·v of a skate of a on the plane of b, with n fixed in a and v the velocity of p_A relative to b's material point
/// there. The constraint is nonholonomic: the velocity is not the derivative of a function of the pose. The value is therefore always zero,
/// and only velocities are constrained.
struct SkateMeasure {
  Vec2 point_a, normal; ///< both in the frame of a
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m;
    const Pair<S> ra = to_ground(a, point_a), n = to_ground(a, normal);
    const Pair<S> reach = offset(a, b) + ra;
    const Pair<S> velocity = point_velocity(a, ra) - point_velocity(b, reach); // as seen from b
    m.direction = n;
    m.lever_a = ra;
    m.lever_b = reach;
    m.rate = dot(n, velocity);
    if constexpr (WithBias) { // derivative of n·v at zero accelerations, ṅ = ω_A ẑ×n
      m.bias = a.omega * cross(n, velocity) - a.omega * a.omega * dot(n, ra);
      if constexpr (!k_is_origin<B>) m.bias += b.omega * b.omega * dot(n, reach) - b.omega * cross(velocity, n);
    }
    return m;
  }
};

} // namespace steplap
