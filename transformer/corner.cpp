#include "transformer/corner.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>

namespace steplap {

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

} // namespace steplap
