// Motion of a body and the wrench that acts on it, as every element sees them.
#pragma once

#include "mbd/types.h"

#include <cmath>

// Measures and laws are a few dozen flops each: a call, and the copy of its result, would cost as much.
#define STEPLAP_INLINE [[gnu::always_inline]] inline

namespace steplap {

/// Pose and velocity of a body's centre of gravity in ground axes; c, s = cos θ, sin θ are kept beside θ
/// so that each body's sine is computed once an evaluation. S is double, or a differentiating scalar.
template <class S> struct Motion {
  S x{0}, y{0}, theta{0}, c{1}, s{0};
  S vx{0}, vy{0}, omega{0};
};

/// Force and couple on a body about its centre of gravity, ground axes.
struct BodyForce {
  double fx = 0.0, fy = 0.0, m = 0.0;
};

/// A planar vector of any scalar; Eigen's own is not used here because the differentiating scalar
/// would drag expression templates through every element.
template <class S> struct Pair {
  S x{0}, y{0};
};

template <class S> STEPLAP_INLINE Pair<S> operator+(const Pair<S>& a, const Pair<S>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class S> STEPLAP_INLINE Pair<S> operator-(const Pair<S>& a, const Pair<S>& b) {
  return {a.x - b.x, a.y - b.y};
}
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

} // namespace steplap
