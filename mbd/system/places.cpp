#include "mbd/system/places.h"

#include <algorithm>

namespace steplap {

namespace {

template <class T> const T* named(const std::vector<T>& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const T& entry) { return entry.name == name; });
  return found == list.end() ? nullptr : &*found;
}

} // namespace

Place place_of(const Model& model, const std::string& name) {
  Place place;
  const Marker* const marker = named(model.markers, name);
  place.body = named(model.bodies, marker ? marker->body : name);
  if (!marker) return place;
  place.angle = marker->angle;
  if (!place.body) {
    place.point = marker->point.value_or(marker->at.value_or(Vec2::Zero()));
    return place;
  }
  if (marker->point) place.point = *marker->point - place.body->cg;
  else if (marker->at) {
    const Vec3 pose = place.body->reference_pose();
    place.point = rotated(*marker->at - Vec2(pose.x(), pose.y()), -pose.z());
  }
  return place;
}

int index_of(const System& system, const Body* body) {
  if (body)
    for (int i = 1; i < system.body_count(); ++i)
      if (system.bodies[i].name == body->name) return i;
  return k_ground;
}

Vec3 pose_of(const System& system, const State& state, const Body* body) {
  if (!body) return Vec3::Zero();
  const int i = index_of(system, body);
  if (i == k_ground) return body->reference_pose();
  return {state.q[3 * i], state.q[3 * i + 1], state.q[3 * i + 2]};
}

bool is_closed(const System& system, const State& state, const std::string& element) {
  for (std::size_t u = 0; u < system.units.size(); ++u)
    if (system.element_names[system.units[u].element] == element) return state.mode[u] != k_contact_open;
  return false;
}

} // namespace steplap
