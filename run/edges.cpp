#include "run/edges.h"

#include "elements/contact_depth.h"
#include "elements/unilateral_contact.h"
#include "run/places.h"
#include "run/quantity_text.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_map>

namespace steplap {

namespace {

constexpr double k_beyond = 1e-3; // relative to the width of the outline; feet may stand on an edge

// Returns the thickness of the outline of body b behind the contact line; nothing if b has no outline.
std::optional<double> thickness_below(const UnilateralContact& contact, const Model& model) {
  const Place b = place_of(model, contact.b);
  if (!b.body || b.body->outline.empty()) return std::nullopt;
  const Vec2 normal = rotated(contact.normal, b.angle).normalized();
  double deepest = 0.0;
  for (const Vec2& corner : b.body->outline) deepest = std::max(deepest, normal.dot(b.point - (corner - b.body->cg)));
  return deepest > 0.0 ? std::optional(deepest) : std::nullopt;
}

std::optional<double> most_depth(const Element& element, const Model& model) {
  const auto* const foot = dynamic_cast<const UnilateralContact*>(&element);
  if (!foot) return largest_depth(element, model);
  return foot->ends ? std::nullopt : thickness_below(*foot, model); // beyond the end of the line the depth has no meaning
}

} // namespace

std::vector<Finding> contacts_too_deep(const LoadedModel& loaded, const std::vector<ChannelRange>& ranges) {
  std::unordered_map<std::string, const ChannelRange*> range_of;
  for (const ChannelRange& range : ranges) range_of.emplace(range.channel->name, &range);
  std::vector<Finding> found;
  for (const ElementEntry& entry : loaded.model.elements) {
    const Element& element = *entry.element;
    const std::optional<double> most = most_depth(element, loaded.model);
    const auto range = range_of.find(element.name + ".gap");
    if (!most || range == range_of.end() || !(-range->second->low.value > *most)) continue;
    found.push_back({"contact_too_deep", FindingLevel::warning,
                     "'" + element.name + "' was pressed " + quantity_text(-range->second->low.value, "m", 1e-3) +
                         " deep at t = " + time_text(range->second->low.t) + " s; beyond " + quantity_text(*most, "m", 1e-3) +
                         " one part is through the other, and what came after is not to be trusted. A larger 'stiffness' keeps them apart",
                     element.where});
  }
  return found;
}

std::vector<Finding> feet_beyond_edges(const LoadedModel& loaded, const State& state) {
  std::vector<Finding> found;
  for (const ElementEntry& entry : loaded.model.elements) {
    const auto* const contact = dynamic_cast<const UnilateralContact*>(entry.element.get());
    if (!contact || contact->ends) continue;
    const Place a = place_of(loaded.model, contact->a), b = place_of(loaded.model, contact->b);
    if (!b.body || b.body->outline.empty() || !is_closed(*loaded.system, state, contact->name)) continue;
    const Vec3 at = pose_of(*loaded.system, state, a.body), on = pose_of(*loaded.system, state, b.body);
    const Vec2 foot = Vec2(at.x(), at.y()) + rotated(a.point, at.z());
    const Vec2 seen = rotated(foot - Vec2(on.x(), on.y()), -on.z());
    const Vec2 normal = rotated(contact->normal, b.angle).normalized(), along(normal.y(), -normal.x());
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec2& corner : b.body->outline) {
      low = std::min(low, along.dot(corner - b.body->cg));
      high = std::max(high, along.dot(corner - b.body->cg));
    }
    const double beyond = std::max(low - along.dot(seen), along.dot(seen) - high);
    if (beyond <= k_beyond * (high - low)) continue;
    found.push_back({"foot_beyond_edge", FindingLevel::warning,
                     "'" + contact->name + "' presses " + quantity_text(beyond, "m", 1e-3) + " beyond the edge of '" + b.body->name +
                         "': the line of a unilateral_contact has no ends, the part has; give it 'ends', or take a polygon_contact",
                     contact->where});
  }
  return found;
}

} // namespace steplap
