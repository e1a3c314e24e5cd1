// Motion of a body and the wrench on it, as read and written by elements.
#pragma once

#include "mbd/base/types.h"
#include "mbd/tape/traced.h"

#include <cmath>
#include <type_traits>

// Forces inlining: measures and laws have only a few dozen operations, so a call and the copy of its result would double their cost.
#define STEPLAP_INLINE [[gnu::always_inline]] inline

namespace steplap {

/// Pose and velocity of a body's centre of gravity, ground axes. c = cos θ and s = sin θ are stored, so that they are computed once per
/// body and evaluation. S is double, a dual number or a recorded number (traced.h).
template <class S> struct Motion {
  S x{0}, y{0}, theta{0}, c{1}, s{0};
  S vx{0}, vy{0}, omega{0};
};

/// Sets θ and its cosine and sine. Transformers in transit turn by a few milliradians: for |θ| < 0.2 rad Taylor series up to θ¹² are used
/// (remainder below 1e-20), at a third of the cost of portable_math.h, which is used for larger angles.
template <class S> STEPLAP_INLINE void set_angle(Motion<S>& m, const std::type_identity_t<S>& theta) {
  m.theta = theta;
  const S z = theta * theta;
  if (z < 0.04) [[likely]] {
    // The terms are summed in pairs (Estrin's scheme), which gives shorter chains of dependent operations. All else in an evaluation waits
    // for this result.
    const S z2 = z * z;
    m.c = 1.0 - z * ((1.0 / 2.0 - z * (1.0 / 24.0)) +
                     z2 * ((1.0 / 720.0 - z * (1.0 / 40320.0)) + z2 * (1.0 / 3628800.0 - z * (1.0 / 479001600.0))));
    m.s = theta - theta * z * ((1.0 / 6.0 - z * (1.0 / 120.0)) + z2 * ((1.0 / 5040.0 - z * (1.0 / 362880.0)) + z2 * (1.0 / 39916800.0)));
  } else {
    find_sin_cos(theta, m.s, m.c);
  }
}

/// Force and moment on a body about its centre of gravity, ground axes.
template <class S> struct BodyForceOf {
  S fx{0.0}, fy{0.0}, m{0.0};
};
using BodyForce = BodyForceOf<double>;

/// A planar vector over any number type. Eigen's vectors are not used, because with dual numbers their expression templates would slow down
/// compilation of every element.
template <class S> struct Pair {
  S x{0}, y{0};

  /// Conversion of a vector of constants.
  template <class T>
    requires(!std::is_same_v<S, T>)
  STEPLAP_INLINE operator Pair<T>() const {
    return {T(x), T(y)};
  } // NOLINT
};

template <class S> STEPLAP_INLINE Pair<S> operator+(const Pair<S>& a, const Pair<S>& b) { return {a.x + b.x, a.y + b.y}; }
template <class S> STEPLAP_INLINE Pair<S> operator-(const Pair<S>& a, const Pair<S>& b) { return {a.x - b.x, a.y - b.y}; }
template <class S> STEPLAP_INLINE Pair<S> operator*(const S& k, const Pair<S>& a) { return {k * a.x, k * a.y}; }
template <class S> STEPLAP_INLINE S dot(const Pair<S>& a, const Pair<S>& b) { return a.x * b.x + a.y * b.y; }
template <class S> STEPLAP_INLINE S cross(const Pair<S>& a, const Pair<S>& b) { return a.x * b.y - a.y * b.x; }
/// Returns ẑ × a.
template <class S> STEPLAP_INLINE Pair<S> perp(const Pair<S>& a) { return {-a.y, a.x}; }

/// Returns a vector that is given in body axes, in ground axes.
template <class S> STEPLAP_INLINE Pair<S> to_ground(const Motion<S>& body, const Vec2& local) {
  return {body.c * local.x() - body.s * local.y(), body.s * local.x() + body.c * local.y()};
}
/// Returns the velocity of the body's point at `lever` (ground axes, from the centre of gravity).
template <class S> STEPLAP_INLINE Pair<S> point_velocity(const Motion<S>& body, const Pair<S>& lever) {
  return {body.vx - body.omega * lever.y, body.vy + body.omega * lever.x};
}

/// Returns the vector from b's centre of gravity to a's.
template <class S> STEPLAP_INLINE Pair<S> offset(const Motion<S>& a, const Motion<S>& b) { return {a.x - b.x, a.y - b.y}; }

template <class S> STEPLAP_INLINE S relative_angle(const Motion<S>& a, const Motion<S>& b) { return a.theta - b.theta; }
template <class S> STEPLAP_INLINE S relative_spin(const Motion<S>& a, const Motion<S>& b) { return a.omega - b.omega; }

/// Takes the place of body b in a measure when the motion of a is relative to b (link.h). All terms with the motion of b then vanish at
/// compile time.
struct Origin {};
struct ZeroVelocity {}; ///< zero velocity

STEPLAP_INLINE Pair<double> to_ground(Origin, const Vec2& local) { return {local.x(), local.y()}; }
template <class S> STEPLAP_INLINE Pair<S> offset(const Motion<S>& a, Origin) { return {a.x, a.y}; }
template <class S> STEPLAP_INLINE S relative_angle(const Motion<S>& a, Origin) { return a.theta; }
template <class S> STEPLAP_INLINE S relative_spin(const Motion<S>& a, Origin) { return a.omega; }
template <class S> STEPLAP_INLINE ZeroVelocity point_velocity(Origin, const Pair<S>&) { return {}; }
template <class S> STEPLAP_INLINE Pair<S> operator-(const Pair<S>& a, ZeroVelocity) { return a; }

template <class B> inline constexpr bool k_is_origin = false;
template <> inline constexpr bool k_is_origin<Origin> = true;

} // namespace steplap
