#include "mbd/run/body_reach.h"

#include "mbd/base/types.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace steplap {

namespace {

// Index of the body of a marker, and distance of the marker from that body's centre of gravity, m; by marker name.
using Places = std::unordered_map<std::string, std::pair<std::size_t, double>>;

double farthest(const std::vector<Vec2>& points, const Vec2& from) {
  double most = 0.0;
  for (const Vec2& p : points) most = std::max(most, (p - from).norm());
  return most;
}

Vec2 place_on(const Body& body, const Marker& marker) {
  if (marker.point) return *marker.point - body.cg;
  if (!marker.at) return Vec2::Zero();
  const Vec3 pose = body.reference_pose();
  return rotated(*marker.at - Vec2(pose.x(), pose.y()), -pose.z());
}

// Returns the largest radius, m, of the circles and outlines that the element defines around its markers.
double rim_of(const ElementEntry& entry) {
  double most = 0.0;
  for (const Field& field : entry.kind->fields.fields()) {
    if (field.unit != "m") continue;
    const FieldValue value = field.get(entry.element.get());
    const double* const number = std::get_if<double>(&value);
    if (number && field.name.starts_with("radius")) most = std::max(most, std::abs(*number));
    const auto* const points = std::get_if<std::vector<Vec2>>(&value);
    if (points && field.name.starts_with("outline")) most = std::max(most, farthest(*points, Vec2::Zero()));
  }
  return most;
}

} // namespace

std::vector<double> body_reaches(const Model& model) {
  std::vector<double> reaches;
  Places places;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    reaches.push_back(farthest(model.bodies[i].outline, model.bodies[i].cg));
    places[model.bodies[i].name] = {i, 0.0};
  }
  for (const Marker& marker : model.markers) {
    const auto body = places.find(marker.body);
    if (body == places.end()) continue;
    const std::size_t i = body->second.first;
    const double distance = place_on(model.bodies[i], marker).norm();
    places.try_emplace(marker.name, i, distance);
    reaches[i] = std::max(reaches[i], distance);
  }
  for (const ElementEntry& entry : model.elements) {
    const double rim = rim_of(entry);
    if (rim == 0.0) continue;
    for (const Field& field : entry.kind->fields.fields()) {
      if (field.type != FieldType::marker) continue;
      const auto place = places.find(std::get<std::string>(field.get(entry.element.get())));
      if (place == places.end()) continue;
      double& reach = reaches[place->second.first];
      reach = std::max(reach, place->second.second + rim);
    }
  }
  return reaches;
}

double scene_extent(const Model& model, const std::vector<double>& reaches) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto add = [&](const Vec2& p, double reach) {
    low = low.cwiseMin(p - Vec2::Constant(reach));
    high = high.cwiseMax(p + Vec2::Constant(reach));
  };
  for (std::size_t i = 0; i < model.bodies.size(); ++i) add(model.bodies[i].reference_pose().head<2>(), reaches[i]);
  for (const Marker& marker : model.markers)
    if (marker.body == "ground") add(marker.at.value_or(marker.point.value_or(Vec2::Zero())), 0.0);
  return model.bodies.empty() ? 0.0 : (high - low).norm();
}

} // namespace steplap
