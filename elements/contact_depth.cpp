#include "elements/contact_depth.h"

#include "elements/convex_outline.h"
#include "elements/polygon_contact.h"
#include "elements/round_contacts.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <limits>

namespace steplap {

namespace {

constexpr double k_endless = std::numeric_limits<double>::infinity();

// Returns the width of an outline; infinite for a half-plane, which has none.
double width_of(const std::vector<Vec2>& given, const std::string& marker, const Model& model) {
  if (!given.empty()) return width_of(convex_outline(given, CompiledMarker{}));
  const auto m = std::find_if(model.markers.begin(), model.markers.end(), [&](const Marker& each) { return each.name == marker; });
  const std::string body = m == model.markers.end() ? marker : m->body;
  const auto b = std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& each) { return each.name == body; });
  return b == model.bodies.end() || b->outline.empty() ? k_endless : width_of(convex_outline(b->outline, CompiledMarker{}));
}

} // namespace

std::optional<double> largest_depth(const Element& element, const Model& model) {
  if (const auto* polygon = dynamic_cast<const PolygonContact*>(&element)) {
    const double a = width_of(polygon->outline_a, polygon->a, model);
    const double b = polygon->normal ? k_endless : width_of(polygon->outline_b, polygon->b, model);
    return b < k_endless ? 0.5 * std::min(a, b) : a;
  }
  if (const auto* circle = dynamic_cast<const CircleContact*>(&element); circle && !circle->inside)
    return circle->radius_a + circle->radius_b;
  if (const auto* segment = dynamic_cast<const SegmentContact*>(&element)) return segment->radius + 0.5 * segment->thickness;
  return std::nullopt;
}

} // namespace steplap
