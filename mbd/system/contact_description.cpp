#include "mbd/system/contact_description.h"

#include <algorithm>

namespace steplap {

ScenePose::PlacedMarker ScenePose::marker(const std::string& name) const {
  const Place place = place_of(model_, name);
  const Vec3 pose = pose_of(system_, state_, place.body);
  return {index_of(system_, place.body), Vec2(pose.x(), pose.y()) + rotated(place.point, pose.z()), pose.z() + place.angle};
}

std::vector<Vec2> ScenePose::outline(const std::string& name, const std::vector<Vec2>& given) const {
  std::vector<Vec2> points;
  if (!given.empty()) {
    const PlacedMarker frame = marker(name);
    for (const Vec2& p : given) points.push_back(frame.point + rotated(p, frame.angle));
  } else if (const Body* const body = place_of(model_, name).body) {
    const Vec3 pose = pose_of(system_, state_, body);
    for (const Vec2& p : body->outline) points.push_back(Vec2(pose.x(), pose.y()) + rotated(p - body->cg, pose.z()));
  }
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 &p = points[i], &q = points[(i + 1) % points.size()];
    area += p.x() * q.y() - p.y() * q.x();
  }
  if (area < 0.0) std::reverse(points.begin(), points.end());
  return points;
}

std::optional<ContactDescription> contact_of(const ElementEntry& entry, const Model& model) {
  if (!entry.kind->contact) return std::nullopt;
  return entry.kind->contact(*entry.element, model);
}

std::optional<double> thickness_behind(const Model& model, const std::string& marker, const Vec2& normal) {
  const Place b = place_of(model, marker);
  if (!b.body || b.body->outline.empty()) return std::nullopt;
  const Vec2 outwards = rotated(normal, b.angle).normalized();
  double deepest = 0.0;
  for (const Vec2& corner : b.body->outline) deepest = std::max(deepest, outwards.dot(b.point - (corner - b.body->cg)));
  return deepest > 0.0 ? std::optional(deepest) : std::nullopt;
}

} // namespace steplap
