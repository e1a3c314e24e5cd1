#include "elements/convex_outline.h"

#include "mbd/base/portable_math.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

// Sine of the largest angle of a corner that counts as straight, for typed coordinates with few digits.
constexpr double k_straight = 1e-9;

std::string place_text(const Vec2& p) {
  char text[64];
  std::snprintf(text, sizeof text, "[%.6g, %.6g]", p.x(), p.y());
  return text;
}

double twice_area(const std::vector<Vec2>& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += cross(Vec2(ring[i] - ring[0]), Vec2(ring[(i + 1) % ring.size()] - ring[0]));
  return sum;
}

// Returns the corners without repeated ones and those on straight edges. `size`: extent of the ring, m.
std::vector<Vec2> true_corners(const std::vector<Vec2>& ring, double size) {
  std::vector<Vec2> apart;
  for (const Vec2& p : ring)
    if (apart.empty() || (p - apart.back()).norm() > 1e-12 * size) apart.push_back(p);
  while (apart.size() > 1 && (apart.front() - apart.back()).norm() <= 1e-12 * size) apart.pop_back();
  std::vector<Vec2> corners;
  const std::size_t n = apart.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = (apart[i] - apart[(i + n - 1) % n]).normalized(), out = (apart[(i + 1) % n] - apart[i]).normalized();
    if (std::abs(cross(in, out)) > k_straight || in.dot(out) < 0.0) corners.push_back(apart[i]);
  }
  return corners;
}

void check_convex(const std::vector<Vec2>& corners) {
  const std::size_t n = corners.size();
  double turned = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = corners[i] - corners[(i + n - 1) % n], out = corners[(i + 1) % n] - corners[i];
    if (!(cross(in, out) > 0.0))
      throw OutlineError("is not convex at " + place_text(corners[i]) + ": split the part into convex ones, with a polygon_contact each");
    turned += portable::atan2(cross(in, out), in.dot(out));
  }
  if (turned > 3.0 * std::numbers::pi) throw OutlineError("crosses itself: give the corners in order, once round");
}

} // namespace

ConvexOutline convex_outline(const std::vector<Vec2>& points, const CompiledMarker& frame) {
  double size = 0.0;
  for (const Vec2& p : points) size = std::max(size, (p - points[0]).norm());
  std::vector<Vec2> corners = true_corners(points, size);
  if (corners.size() < 3) throw OutlineError("has no area: three corners that are not in one line are needed");
  const double area = 0.5 * twice_area(corners);
  if (!(std::abs(area) > 1e-12 * size * size)) throw OutlineError("has no area");
  if (area < 0.0) std::reverse(corners.begin(), corners.end());
  check_convex(corners);
  if (corners.size() > k_most_corners)
    throw OutlineError("has " + std::to_string(corners.size()) + " corners: " + std::to_string(k_most_corners) +
                       " are the most (something round is a circle_contact)");
  ConvexOutline outline;
  for (const Vec2& p : corners) outline.corners.push_back(frame.point + rotated(p, frame.angle));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 along = (outline.corners[(i + 1) % corners.size()] - outline.corners[i]).normalized();
    outline.normals.emplace_back(along.y(), -along.x());
    outline.offsets.push_back(outline.normals.back().dot(outline.corners[i]));
  }
  return outline;
}

ConvexOutline half_plane(const Vec2& normal, const CompiledMarker& frame) {
  ConvexOutline outline;
  outline.normals.push_back(rotated(Vec2(normal.normalized()), frame.angle));
  outline.offsets.push_back(outline.normals[0].dot(frame.point));
  return outline;
}

double width_of(const ConvexOutline& outline) {
  double width = std::numeric_limits<double>::infinity();
  for (int edge = 0; edge < outline.edge_count() && !outline.corners.empty(); ++edge) {
    double deepest = 0.0;
    for (const Vec2& corner : outline.corners) deepest = std::max(deepest, outline.offsets[edge] - outline.normals[edge].dot(corner));
    width = std::min(width, deepest);
  }
  return width;
}

double reach_of(const ConvexOutline& outline) {
  double reach = 0.0;
  for (const Vec2& corner : outline.corners) reach = std::max(reach, corner.norm());
  return reach;
}

std::string body_of(const std::string& marker, const SystemBuilder& builder) {
  const std::vector<Marker>& markers = builder.model().markers;
  const auto found = std::find_if(markers.begin(), markers.end(), [&](const Marker& m) { return m.name == marker; });
  return found == markers.end() ? marker : found->body;
}

const std::vector<Vec2>& outline_of_body(const std::string& body, const SystemBuilder& builder) {
  static const std::vector<Vec2> k_none;
  const std::vector<Body>& bodies = builder.model().bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == body; });
  return found == bodies.end() ? k_none : found->outline;
}

} // namespace steplap
