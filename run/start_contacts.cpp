#include "run/start_contacts.h"

#include "elements/convex_outline.h"
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

using Placed = PlacedOutline<double>;

// Returns the frame of the outline that a field gives, or of that of the body.
CompiledMarker frame_of(const Place& marker, bool is_given) {
  CompiledMarker frame;
  if (is_given) frame = {k_ground, marker.point, marker.angle};
  else if (marker.body) frame.point = -marker.body->cg;
  return frame;
}

// Returns the outline of one side of the contact at its pose, ground axes; a half-plane for the ground and for `normal`.
Placed placed_outline(const std::vector<Vec2>& given, const std::optional<Vec2>& normal, const Place& marker, const Vec3& pose) {
  const bool has_own = marker.body && !marker.body->outline.empty();
  const ConvexOutline outline = normal || (given.empty() && !has_own)
                                    ? half_plane(normal.value_or(Vec2(0.0, 1.0)), {k_ground, marker.point, marker.angle})
                                    : convex_outline(given.empty() ? marker.body->outline : given, frame_of(marker, !given.empty()));
  Motion<double> motion;
  set_angle(motion, pose.z());
  Placed placed;
  place_outline(outline, motion, Pair<double>{pose.x(), pose.y()}, placed);
  return placed;
}

// Returns the middle of the overlap, or the corner that is nearest to the other outline.
Vec2 touching_place(const Placed& a, const Placed& b) {
  const Separation nearest = separation_of(a, b);
  const Pair<double> corner = nearest.face < a.edge_count ? b.corner[nearest.corner] : a.corner[nearest.corner];
  CutRing<double> ring, rest;
  ring.size = a.corner_count;
  for (int i = 0; i < a.corner_count; ++i) ring.corner[i] = a.corner[i], ring.edge[i] = i;
  for (int j = 0; j < b.edge_count; ++j) {
    cut(
        ring, [&](const Pair<double>& x) { return b.offset[j] - dot(b.normal[j], x); }, a.edge_count + j, rest);
    ring = rest;
  }
  if (ring.size < 3) return {corner.x, corner.y};
  Vec2 sum = Vec2::Zero();
  for (int i = 0; i < ring.size; ++i) sum += Vec2(ring.corner[i].x, ring.corner[i].y);
  return sum / ring.size;
}

Vec2 place_of_outlines(const PolygonContact& contact, const LoadedModel& loaded, const State& state) {
  const Place a = place_of(loaded.model, contact.a), b = place_of(loaded.model, contact.b);
  const System& system = *loaded.system;
  return touching_place(placed_outline(contact.outline_a, {}, a, pose_of(system, state, a.body)),
                        placed_outline(contact.outline_b, contact.normal, b, pose_of(system, state, b.body)));
}

} // namespace

std::optional<std::pair<std::string, std::string>> contact_ends(const Element& element) {
  if (const auto* const foot = dynamic_cast<const UnilateralContact*>(&element)) return std::pair{foot->a, foot->b};
  if (const auto* const round = dynamic_cast<const RoundContact*>(&element)) return std::pair{round->a, round->b};
  if (const auto* const tyre = dynamic_cast<const Tyre*>(&element)) return std::pair{tyre->a, tyre->b};
  if (const auto* const outlines = dynamic_cast<const PolygonContact*>(&element)) return std::pair{outlines->a, outlines->b};
  return std::nullopt;
}

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
    const auto ends = contact_ends(*entry.element);
    const std::string& name = entry.element->name;
    const auto gap = ends ? value(name + ".gap") : std::nullopt, force = ends ? value(name + ".force") : std::nullopt;
    if (ends) ++contact;
    if (!gap || !force) continue;
    const Place a = place_of(loaded.model, ends->first), b = place_of(loaded.model, ends->second);
    const Vec3 pose = pose_of(system, still, a.body);
    const auto* const outlines = dynamic_cast<const PolygonContact*>(entry.element.get());
    contacts.push_back({&entry, contact, index_of(system, a.body), index_of(system, b.body), *gap, *force,
                        outlines ? place_of_outlines(*outlines, loaded, still) : Vec2(pose.x(), pose.y()) + rotated(a.point, pose.z()),
                        value(name + ".along")});
  }
  return contacts;
}

} // namespace steplap
