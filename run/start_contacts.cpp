#include "run/start_contacts.h"

#include "elements/machinery/tyre.h"
#include "elements/polygon_contact.h"
#include "elements/round_contacts.h"
#include "elements/unilateral_contact.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/statics.h"
#include "run/places.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace steplap {

namespace {

// Returns the names of the markers of a contact, if the element is one.
std::optional<std::pair<std::string, std::string>> ends_of(const Element& element) {
  if (const auto* const foot = dynamic_cast<const UnilateralContact*>(&element)) return std::pair{foot->a, foot->b};
  if (const auto* const round = dynamic_cast<const RoundContact*>(&element)) return std::pair{round->a, round->b};
  if (const auto* const tyre = dynamic_cast<const Tyre*>(&element)) return std::pair{tyre->a, tyre->b};
  if (const auto* const outlines = dynamic_cast<const PolygonContact*>(&element)) return std::pair{outlines->a, outlines->b};
  return std::nullopt;
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
  const System& system = *loaded.system;
  State still = state;
  std::fill(still.v.begin(), still.v.end(), 0.0);
  Statics statics(system);
  statics.evaluate(still);
  Snapshot snapshot;
  snapshot.t = still.t;
  snapshot.motion = statics.motion().data();
  snapshot.evaluation = &statics.evaluation();
  snapshot.memory = still.memory.data();
  std::unordered_map<std::string, const Channel*> channel_of;
  for (const Channel& channel : system.channels) channel_of.emplace(channel.name, &channel);
  const auto value = [&](const std::string& name) -> std::optional<double> {
    const auto found = channel_of.find(name);
    return found == channel_of.end() ? std::nullopt : std::optional(found->second->value(snapshot));
  };
  std::vector<ContactAtStart> contacts;
  int contact = -1; // elements are compiled in the order of the file, and each of these has one contact
  for (const ElementEntry& entry : loaded.model.elements) {
    const auto ends = ends_of(*entry.element);
    const std::string& name = entry.element->name;
    const auto gap = ends ? value(name + ".gap") : std::nullopt, force = ends ? value(name + ".force") : std::nullopt;
    if (ends) ++contact;
    if (!gap || !force) continue;
    const Place a = place_of(loaded.model, ends->first), b = place_of(loaded.model, ends->second);
    const Vec3 pose = pose_of(system, still, a.body);
    contacts.push_back({&entry, contact, index_of(system, a.body), index_of(system, b.body), *gap, *force,
                        Vec2(pose.x(), pose.y()) + rotated(a.point, pose.z()), value(name + ".along")});
  }
  return contacts;
}

} // namespace steplap
