#include "transformer/core/corner.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Returns the part of a convex ring with sign·(n·(p − origin) − q) ≥ 0.
std::vector<Vec2> cut(const std::vector<Vec2>& ring, const CornerFrame& frame, double q, double sign) {
  const auto beyond = [&](const Vec2& p) { return sign * (frame.across.dot(p - frame.origin) - q); };
  std::vector<Vec2> left;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &from = ring[i], &to = ring[(i + 1) % ring.size()];
    const double d = beyond(from), e = beyond(to);
    if (d >= 0.0) left.push_back(from);
    if ((d < 0.0) != (e < 0.0)) left.emplace_back(from + (to - from) * (d / (d - e)));
  }
  return left;
}

std::vector<Vec2> rectangle(double x0, double x1, double y0, double y1) {
  const double left = std::min(x0, x1), right = std::max(x0, x1), low = std::min(y0, y1), high = std::max(y0, y1);
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

} // namespace

CornerFrame corner_frame(const Mitre& mitre, double side, double level) {
  const double diagonal = portable::hypot(mitre.limb_width, mitre.yoke_height);
  double c = mitre.limb_width / diagonal, s = mitre.yoke_height / diagonal;
  if (mitre.angle) {
    const portable::SinCos angle = portable::sin_cos(*mitre.angle);
    c = angle.cos;
    s = angle.sin;
  }
  CornerFrame frame;
  frame.origin = {-0.5 * side * mitre.limb_width, level * (0.5 * mitre.core_height - mitre.yoke_height)};
  frame.along = {side * c, level * s};
  frame.across = {side * s, -level * c};
  frame.length = mitre.angle ? std::min(mitre.limb_width / c, mitre.yoke_height / s) : diagonal;
  return frame;
}

CornerFrame notch_frame(const Mitre& mitre, double side, double level) {
  CornerFrame frame = corner_frame(mitre, side, level);
  frame.length = 0.5 * mitre.limb_width / portable::cos(*mitre.angle);
  return frame;
}

std::vector<Vec2> band(const CornerFrame& frame, double s0, double s1, double q0, double q1) {
  const auto at = [&](double s, double q) { return Vec2(frame.origin + s * frame.along + q * frame.across); };
  return {at(s0, q0), at(s1, q0), at(s1, q1), at(s0, q1)};
}

std::vector<Vec2> beyond(const std::vector<Vec2>& ring, const CornerFrame& frame, double q) { return cut(ring, frame, q, 1.0); }

std::vector<Vec2> before(const std::vector<Vec2>& ring, const CornerFrame& frame, double q) { return cut(ring, frame, q, -1.0); }

std::vector<Vec2> limb_end(const Mitre& m, double side, double level, double q) {
  const auto strip = rectangle(-0.5 * m.limb_width, 0.5 * m.limb_width, 0.0, 0.5 * level * m.core_height);
  return beyond(strip, corner_frame(m, side, level), q);
}

std::vector<Vec2> pointed_end(const Mitre& m, double level, double q) {
  const auto strip = rectangle(-0.5 * m.limb_width, 0.5 * m.limb_width, 0.0, 0.5 * level * m.core_height);
  return beyond(beyond(strip, notch_frame(m, 1.0, level), q), notch_frame(m, -1.0, level), q);
}

std::vector<Vec2> whole_limb(const Mitre& m, double side, double q) {
  const auto strip = rectangle(-0.5 * m.limb_width, 0.5 * m.limb_width, -0.5 * m.core_height, 0.5 * m.core_height);
  return beyond(beyond(strip, corner_frame(m, side, 1.0), q), corner_frame(m, side, -1.0), q);
}

std::vector<Vec2> whole_pointed_limb(const Mitre& m, double q) {
  auto ring = rectangle(-0.5 * m.limb_width, 0.5 * m.limb_width, -0.5 * m.core_height, 0.5 * m.core_height);
  for (const double level : {1.0, -1.0})
    for (const double side : {1.0, -1.0}) ring = beyond(ring, notch_frame(m, side, level), q);
  return ring;
}

std::vector<Vec2> yoke_end(const Mitre& m, double side, double level, double q, double reach) {
  const double top = 0.5 * level * m.core_height;
  const auto strip = rectangle(-side * reach, 0.5 * side * m.limb_width, top - level * m.yoke_height, top);
  return before(strip, corner_frame(m, side, level), q);
}

// The mitre that rises towards −side begins at the window's corner on side `side`.
std::vector<Vec2> yoke_half(const Mitre& m, double side, double level, double q, double reach) {
  const double top = 0.5 * level * m.core_height;
  const auto strip = rectangle(0.0, side * reach, top - level * m.yoke_height, top);
  return before(strip, notch_frame(m, -side, level), q);
}

// The line at q crosses the rectangle if a corner of the rectangle lies beyond it, so the limit is the distance of the nearer of the two
// corners that are not on the mitre.
double cut_distance_limit(const Mitre& m) {
  const CornerFrame f = corner_frame(m, 1.0, 1.0);
  const Vec2 below(m.limb_width, 0.0), above(0.0, m.yoke_height);
  return std::min(f.across.dot(below), -f.across.dot(above));
}

} // namespace steplap
