// Small vocabulary shared by all rooms: planar vectors and their products.
//
// Frame: x forward (direction of travel), y up, angles counter-clockwise. SI units and radians.
#pragma once

#include "mbd/base/portable_math.h"

#include <Eigen/Core>

namespace steplap {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;

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
