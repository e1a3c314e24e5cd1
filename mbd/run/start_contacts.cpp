#include "mbd/run/start_contacts.h"

#include "mbd/rest/assembly.h"
#include "mbd/rest/statics.h"
#include "mbd/system/contact_description.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace steplap {

namespace {

Vec2 middle_of(const std::vector<ContactPoint>& points) {
  Vec2 sum = Vec2::Zero();
  for (const ContactPoint& each : points) sum += each.point;
  return points.empty() ? sum : Vec2(sum / static_cast<double>(points.size()));
}

} // namespace

State beginning_of(const LoadedModel& loaded, bool as_given) {
  return as_given ? assembled_start(*loaded.system, loaded.assembled) : initial_state_of(loaded);
}

double size_of_pair(const System& system, int a, int b) {
  double size = 0.0;
  for (const int i : {a, b}) {
    if (i == k_ground) continue;
    const double own = std::sqrt(system.bodies[i].inertia / system.bodies[i].mass);
    size = size == 0.0 ? own : std::min(size, own);
  }
  return size;
}

std::vector<ContactAtStart> contacts_at(const LoadedModel& loaded, const State& state) {
  const std::vector<ElementEntry>& elements = loaded.model.elements;
  if (std::none_of(elements.begin(), elements.end(), [](const ElementEntry& entry) { return entry.kind->contact != nullptr; })) return {};
  const System& system = *loaded.system;
  State still = state;
  std::fill(still.v.begin(), still.v.end(), 0.0);
  Statics statics(system);
  statics.evaluate(still);
  Snapshot snapshot;
  snapshot.t = still.t;
  snapshot.motion = statics.motion().data();
  snapshot.evaluation = &statics.evaluation();
  snapshot.impacts = still.impacts.data();
  std::unordered_map<std::string, const Channel*> channel_of;
  for (const Channel& channel : system.channels) channel_of.emplace(channel.name, &channel);
  const auto value = [&](const std::string& name) -> std::optional<double> {
    const auto found = channel_of.find(name);
    return found == channel_of.end() ? std::nullopt : std::optional(found->second->value(snapshot));
  };
  const ScenePose pose(loaded.model, system, still);
  std::vector<ContactAtStart> contacts;
  int contact = -1; // elements are compiled in the order of the file, and each contact element has one contact
  for (const ElementEntry& entry : elements) {
    const auto description = contact_of(entry, loaded.model);
    const std::string& name = entry.element->name;
    const auto gap = description ? value(name + ".gap") : std::nullopt, force = description ? value(name + ".force") : std::nullopt;
    if (description) ++contact;
    if (!gap || !force) continue;
    const Place a = place_of(loaded.model, description->a), b = place_of(loaded.model, description->b);
    contacts.push_back({&entry, contact, index_of(system, a.body), index_of(system, b.body), *gap, *force,
                        middle_of(description->points(*entry.element, pose)), value(name + ".along")});
  }
  return contacts;
}

} // namespace steplap
