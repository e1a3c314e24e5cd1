// Planar vectors and their products.
//
// Frame: x forward (direction of travel), y up, angles counter-clockwise. SI units and radians.
#pragma once

#include "mbd/base/portable_math.h"

#include <Eigen/Core>

namespace steplap {

using Vec2 = Eigen::Vector2d; ///< a point, m, or a force, N
using Vec3 = Eigen::Vector3d; ///< a pose (x, y, θ), m and rad, or a wrench (Fx, Fy, M), N and N m
using Mat3 = Eigen::Matrix3d; ///< maps poses, twists or wrenches
using VecX = Eigen::VectorXd; ///< any length
using MatX = Eigen::MatrixXd; ///< any size

inline constexpr int k_ground = 0; ///< index of the ground among the bodies of a compiled system

/// a × b, the z component of the cross product.
[[nodiscard]] inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// ẑ × a: a turned by +90°.
[[nodiscard]] inline Vec2 perp(const Vec2& a) { return {-a.y(), a.x()}; }

/// R(angle) a.
[[nodiscard]] inline Vec2 rotated(const Vec2& a, double angle) {
  const auto [s, c] = portable::sin_cos(angle);
  return {c * a.x() - s * a.y(), s * a.x() + c * a.y()};
}

} // namespace steplap
