// Motion of a body and the wrench that acts on it, as every element sees them.
#pragma once

#include "mbd/base/types.h"
#include "mbd/tape/traced.h"

#include <cmath>
#include <type_traits>

// Measures and laws are a few dozen flops each: a call, and the copy of its result, would cost as much.
#define STEPLAP_INLINE [[gnu::always_inline]] inline

namespace steplap {

/// Pose and velocity of a body's centre of gravity in ground axes; c, s = cos θ, sin θ are kept beside θ
/// so that each body's sine is computed once an evaluation. S is double, a differentiating scalar, or one that is
/// written down (traced.h).
template <class S> struct Motion {
  S x{0}, y{0}, theta{0}, c{1}, s{0};
  S vx{0}, vy{0}, omega{0};
};

/// Sets θ with its cosine and sine. Machines in transit turn by a few milliradians: up to 0.2 rad
/// the series to θ¹² (remainder below 1e-20) costs a third of portable_math.h's functions, which
/// hold beyond.
template <class S> STEPLAP_INLINE void set_angle(Motion<S>& m, const std::type_identity_t<S>& theta) {
  m.theta = theta;
  const S z = theta * theta;
  if (z < 0.04) [[likely]] {
    // In pairs (Estrin): everything else of an evaluation waits for this, and short chains end sooner.
    const S z2 = z * z;
    m.c = 1.0 - z * ((1.0 / 2.0 - z * (1.0 / 24.0)) +
                     z2 * ((1.0 / 720.0 - z * (1.0 / 40320.0)) + z2 * (1.0 / 3628800.0 - z * (1.0 / 479001600.0))));
    m.s = theta - theta * z * ((1.0 / 6.0 - z * (1.0 / 120.0)) + z2 * ((1.0 / 5040.0 - z * (1.0 / 362880.0)) + z2 * (1.0 / 39916800.0)));
  } else {
    find_sin_cos(theta, m.s, m.c);
  }
}

/// Force and couple on a body about its centre of gravity, ground axes.
template <class S> struct BodyForceOf {
  S fx{0.0}, fy{0.0}, m{0.0};
};
using BodyForce = BodyForceOf<double>;

/// A planar vector of any scalar; Eigen's own is not used here because the differentiating scalar
/// would drag expression templates through every element.
template <class S> struct Pair {
  S x{0}, y{0};

  /// A constant.
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
/// ẑ × a.
template <class S> STEPLAP_INLINE Pair<S> perp(const Pair<S>& a) { return {-a.y, a.x}; }

/// A vector fixed in the body, in ground axes.
template <class S> STEPLAP_INLINE Pair<S> to_ground(const Motion<S>& body, const Vec2& local) {
  return {body.c * local.x() - body.s * local.y(), body.s * local.x() + body.c * local.y()};
}
/// Velocity of the body's point at `lever` (ground axes, from the centre of gravity).
template <class S> STEPLAP_INLINE Pair<S> point_velocity(const Motion<S>& body, const Pair<S>& lever) {
  return {body.vx - body.omega * lever.y, body.vy + body.omega * lever.x};
}

/// Vector from b's centre of gravity to a's.
template <class S> STEPLAP_INLINE Pair<S> offset(const Motion<S>& a, const Motion<S>& b) { return {a.x - b.x, a.y - b.y}; }

template <class S> STEPLAP_INLINE S relative_angle(const Motion<S>& a, const Motion<S>& b) { return a.theta - b.theta; }
template <class S> STEPLAP_INLINE S relative_spin(const Motion<S>& a, const Motion<S>& b) { return a.omega - b.omega; }

/// Stands for body b where a's motion is given as b sees it (link.h): what depends on b's own motion
/// then costs nothing, and the compiler need not be trusted to find that out.
struct Origin {};
struct Still {}; ///< a velocity of zero

STEPLAP_INLINE Pair<double> to_ground(Origin, const Vec2& local) { return {local.x(), local.y()}; }
template <class S> STEPLAP_INLINE Pair<S> offset(const Motion<S>& a, Origin) { return {a.x, a.y}; }
template <class S> STEPLAP_INLINE S relative_angle(const Motion<S>& a, Origin) { return a.theta; }
template <class S> STEPLAP_INLINE S relative_spin(const Motion<S>& a, Origin) { return a.omega; }
template <class S> STEPLAP_INLINE Still point_velocity(Origin, const Pair<S>&) { return {}; }
template <class S> STEPLAP_INLINE Pair<S> operator-(const Pair<S>& a, Still) { return a; }

template <class B> inline constexpr bool k_is_origin = false;
template <> inline constexpr bool k_is_origin<Origin> = true;

} // namespace steplap
