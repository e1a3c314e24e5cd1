#include "elements/views/kind_checks.h"

#include "elements/round_contacts.h"
#include "mbd/base/number_text.h"
#include "mbd/model/entries.h"
#include "mbd/system/places.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

namespace steplap {

namespace {

constexpr double k_same = 1e-9;     // tolerance of points, m: accuracy of typed coordinates
constexpr double k_straight = 1e-9; // smallest angle of a corner, rad

struct End {
  const SegmentContact* contact = nullptr;
  Vec2 direction = Vec2::Zero(); ///< unit vector from the corner along the segment
};
using Rounded = std::array<double, 2>;
using Track = std::tuple<const Body*, Rounded, const Body*>; // body of the segments, circle, body of the circle

Rounded rounded(const Vec2& p) { return {std::round(p.x() / k_same), std::round(p.y() / k_same)}; }

// Returns true if the circle, in its given position, is on the inner side of the corner, where it touches both segments instead of their
// common end point.
bool is_inner(const Vec2& d1, const Vec2& d2, const Vec2& to_circle) {
  const double turn = cross(d1, d2);
  return std::abs(turn) > k_straight && cross(d1, to_circle) * turn > 0.0 && cross(to_circle, d2) * turn > 0.0;
}

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value + 0.0);
  return text;
}

} // namespace

std::vector<Finding> doubled_corners(const LoadedModel& loaded) {
  const State given = loaded.system->initial_state();
  std::map<std::pair<Track, Rounded>, std::vector<End>> ends;
  std::map<Track, Finding> found;
  std::vector<Track> order;
  for (const SegmentContact* const contact : elements_of<SegmentContact>(loaded.model)) {
    const Place a = place_of(loaded.model, contact->a), b = place_of(loaded.model, contact->b);
    const Vec3 at = pose_of(*loaded.system, given, a.body), on = pose_of(*loaded.system, given, b.body);
    const Vec2 centre = rotated(Vec2(at.x() - on.x(), at.y() - on.y()) + rotated(a.point, at.z()), -on.z());
    const Vec2 from = b.point + rotated(contact->from, b.angle), to = b.point + rotated(contact->to, b.angle);
    const Track pair{a.body, rounded(a.point), b.body};
    for (const bool is_from : {true, false}) {
      const Vec2 corner = is_from ? from : to, other = is_from ? to : from;
      std::vector<End>& here = ends[{pair, rounded(corner)}];
      const End end{contact, (other - corner).normalized()};
      for (const End& before : here) {
        if (before.contact == contact || is_inner(before.direction, end.direction, centre - corner) || found.count(pair) > 0) continue;
        order.push_back(pair);
        found[pair] = {"doubled_corner", FindingLevel::warning,
                       "segment_contacts '" + before.contact->name + "' and '" + contact->name + "' end at the same point of '" +
                           contact->b +
                           "': over that corner both press on the circle, with twice the stiffness, damping and friction of one. " +
                           "One presses at a time where the other ends short of the corner by sqrt(2 r d), r the radius and d the depth: " +
                           text_of(1e3 * std::sqrt(2e-3 * std::max(contact->radius, 0.0))) + " mm for a depth of 1 mm",
                       contact->where};
      }
      here.push_back(end);
    }
  }
  std::vector<Finding> findings;
  for (const Track& pair : order) findings.push_back(found[pair]);
  return findings;
}

} // namespace steplap
