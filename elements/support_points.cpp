#include "elements/support_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_flat = 0.02; // largest angle, rad, between faces in full contact
constexpr double k_endless = std::numeric_limits<double>::infinity();

struct Support {
  double gap = -k_endless; ///< gap of the supporting face, m
  Vec2 normal, origin;
  double low = 0.0, high = 0.0; ///< ends of the touching part along the face, m
  bool is_of_a = false;         ///< the face belongs to a
};

// Stores the face with outward normal n in `best` if `other` penetrates it less than the best face so far.
void try_face(const Vec2& n, const Vec2& origin, double from, double to, const std::vector<Vec2>& other, bool is_of_a, Support& best) {
  const Vec2 along(n.y(), -n.x());
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < other.size(); ++i)
    if (n.dot(other[i] - other[lowest]) < 0.0) lowest = i;
  const double gap = n.dot(other[lowest] - origin);
  if (gap <= best.gap) return;
  double low = along.dot(other[lowest]), high = low;
  for (const Vec2& corner : other) {
    const Vec2 reach = corner - other[lowest];
    if (std::abs(n.dot(reach)) > k_flat * std::abs(along.dot(reach))) continue;
    low = std::min(low, along.dot(corner));
    high = std::max(high, along.dot(corner));
  }
  best = {gap, n, origin, std::max(low, from), std::min(high, to), is_of_a};
}

void try_faces(const std::vector<Vec2>& faces, const std::vector<Vec2>& other, bool are_of_a, Support& best) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vec2 &from = faces[i], &to = faces[(i + 1) % faces.size()];
    if (from == to) continue;
    const Vec2 edge = (to - from).normalized(), n(edge.y(), -edge.x()), along(n.y(), -n.x());
    const double one = along.dot(from), two = along.dot(to);
    try_face(n, from, std::min(one, two), std::max(one, two), other, are_of_a, best);
  }
}

} // namespace

std::vector<ContactPoint> support_points(const std::vector<Vec2>& a, const std::vector<Vec2>& b, const Vec2& origin, const Vec2& up) {
  if (a.empty()) return {};
  Support best;
  if (b.empty()) {
    try_face(up, origin, -k_endless, k_endless, a, false, best);
  } else {
    try_faces(b, a, false, best);
    try_faces(a, b, true, best);
  }
  const Vec2 along(best.normal.y(), -best.normal.x()), on_face = best.normal * best.normal.dot(best.origin);
  const Vec2 normal = best.is_of_a ? Vec2(-best.normal) : best.normal;
  const ContactPoint low{on_face + best.low * along, normal}, high{on_face + best.high * along, normal};
  if (best.high - best.low <= 0.0) return {low};
  return along.x() >= 0.0 ? std::vector{low, high} : std::vector{high, low}; // ordered from left to right
}

} // namespace steplap
