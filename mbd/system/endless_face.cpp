#include "mbd/system/endless_face.h"

#include <algorithm>

namespace steplap {

double distance_beyond(const EndlessFace& face, double along) { return std::max(face.low - along, along - face.high); }

FacePlace place_on(const EndlessFace& face, const Motion<double>* motion) {
  const Motion<double>&a = motion[face.a], &b = motion[face.b];
  const Pair<double> along = to_ground(b, Vec2(face.normal.y(), -face.normal.x()));
  const Pair<double> normal = to_ground(b, face.normal);
  const double depth_of_origin = face.normal.dot(face.origin);
  FacePlace farthest;
  bool is_found = false;
  for (const Vec2& point : face.points) {
    const Pair<double> arm = to_ground(a, point);
    const Pair<double> r{a.x + arm.x - b.x, a.y + arm.y - b.y}; // from b's centre of gravity
    if (face.points.size() > 1 && dot(normal, r) > depth_of_origin) continue;
    // d/dt (t · r) with t fixed in b: t · ṙ + ω_b (ẑ × t) · r, and ẑ × t = n for t = (n_y, −n_x).
    const Pair<double> velocity{a.vx - a.omega * arm.y - b.vx, a.vy + a.omega * arm.x - b.vy};
    const FacePlace place{dot(along, r), dot(along, velocity) + b.omega * dot(normal, r)};
    if (is_found && distance_beyond(face, place.along) <= distance_beyond(face, farthest.along)) continue;
    farthest = place;
    is_found = true;
  }
  return farthest;
}

} // namespace steplap
