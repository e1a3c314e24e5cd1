// Random polygons, twists and wrenches for the tests of elements/step_lap/patch, the same on every machine.
#pragma once

#include "elements/step_lap/patch/limit_surface.h"
#include "elements/step_lap/patch/overlap.h"
#include "tests/sanitized.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace steplap::patch_cases {

/// Fewer cases under the address sanitizer, which is some twenty times slower.
#ifdef STEPLAP_TESTS_SANITIZED
inline constexpr int k_thin_out = 20;
#else
inline constexpr int k_thin_out = 1;
#endif
inline constexpr int cases(int n) { return n > k_thin_out ? n / k_thin_out : 1; }

/// Uniform and other draws straight from the generator: the library's distributions differ.
/// In which order arguments are drawn is the compiler's choice: clang's shapes are not GCC's.
class Draw {
public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double within(double low, double high) { return low + (high - low) * unit(); }
  int index(int n) { return static_cast<int>(unit() * n); }
  bool coin() { return unit() < 0.5; }
  double sign() { return coin() ? 1.0 : -1.0; }
  /// Positive, log-uniform.
  double scale(double low, double high) { return low * std::pow(high / low, unit()); }
  Vec2 point(double size) { return {within(-size, size), within(-size, size)}; }
  /// Twist with ω over many orders of magnitude against v, and sometimes one of them zero.
  Vec3 twist() {
    Vec3 nu(within(-1, 1), within(-1, 1), sign() * scale(1e-6, 1e3));
    const double kind = unit();
    if (kind < 0.05) nu[2] = 0;
    else if (kind < 0.1) nu[0] = nu[1] = 0;
    return nu;
  }

private:
  std::mt19937_64 engine_;
};

/// Vertices at rising angles; convex if all radii are equal, else star-shaped.
inline Ring star(Draw& draw, int n, double inner, double outer, const Vec2& centre = {0, 0}) {
  std::vector<double> angles(n);
  do {
    for (double& a : angles) a = draw.within(0, 2 * std::numbers::pi);
    std::sort(angles.begin(), angles.end());
    // a gap above π would put the centre outside, a large one near an edge
  } while ([&] {
    const double widest = n < 5 ? 3.0 : 2.2;
    for (int i = 0; i < n; ++i)
      if (angles[(i + 1) % n] - angles[i] + (i + 1 == n ? 2 * std::numbers::pi : 0) > widest) return true;
    return false;
  }());
  Ring ring;
  for (const double a : angles) {
    const double r = draw.within(inner, outer);
    ring.push_back(centre + r * Vec2(std::cos(a), std::sin(a)));
  }
  return ring;
}

inline Ring stretched(Ring ring, double factor, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec2& p : ring) {
    const Vec2 q(p.x(), factor * p.y());
    p = {c * q.x() - s * q.y(), s * q.x() + c * q.y()};
  }
  return ring;
}

/// Convex polygon of radius 1, up to 20 times longer than wide.
inline Polygon convex_polygon(Draw& draw) {
  return {stretched(star(draw, 3 + draw.index(6), 1, 1), draw.scale(0.05, 1), draw.within(0, 6.3)), {}};
}

/// Star-shaped polygon, with a hole about its centre every other time.
inline Polygon concave_polygon(Draw& draw) {
  Polygon polygon{star(draw, 5 + draw.index(8), 0.5, 1.2), {}};
  if (draw.coin()) {
    Ring hole = star(draw, 3 + draw.index(4), 0.02, 0.15);
    std::reverse(hole.begin(), hole.end());
    polygon.holes.push_back(hole);
  }
  return polygon;
}

inline Pose pose(Draw& draw, double reach) { return {draw.within(-reach, reach), draw.within(-reach, reach), draw.within(-3.2, 3.2)}; }

/// One to three pieces, convex or not, of different traction, about a reference somewhere near.
inline Patch patch(Draw& draw) {
  Patch out(draw.point(2));
  for (int n = 1 + draw.index(3); n > 0; --n) {
    Polygon polygon = draw.coin() ? convex_polygon(draw) : concave_polygon(draw);
    const Vec2 shift = draw.point(3);
    const double size = draw.scale(0.1, 1);
    const auto move = [&](Ring& ring) {
      for (Vec2& p : ring) p = shift + size * p;
    };
    move(polygon.outer);
    for (Ring& hole : polygon.holes) move(hole);
    out.add(polygon, draw.within(0.5, 2));
  }
  if (draw.unit() < 0.95) // without, every far evaluation makes its own table: same values, slower
    out.prepare();
  return out;
}

/// Largest speed of any point of the patch under ν: what errors of h are measured by.
inline double fastest(const Patch& patch, const Vec3& nu) {
  double speed = 0;
  for (const auto& piece : patch.pieces()) {
    const Vec2 arm = piece.centroid - patch.reference();
    const Vec2 v(nu[0] - nu[2] * arm.y(), nu[1] + nu[2] * arm.x());
    speed = std::max(speed, v.norm() + std::abs(nu[2]) * piece.radius);
  }
  return speed;
}

/// Farthest point of the patch from its reference.
inline double reach(const Patch& patch) {
  double far = 0;
  for (const auto& piece : patch.pieces()) far = std::max(far, (piece.centroid - patch.reference()).norm() + piece.radius);
  return far;
}

} // namespace steplap::patch_cases
