#include "elements/machinery/tyre.h"

#include "elements/machinery/tyre_contact.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/contact_description.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace steplap {

namespace {

const Vec2 k_up(0.0, 1.0); // normal of a flat road, in marker b's axes

bool check(const Tyre& e, SystemBuilder& builder) {
  const auto fail = [&](const std::string& message) {
    builder.error(message);
    return false;
  };
  if (builder.marker(e.a).body == builder.marker(e.b).body) return fail("rolls on its own body: name markers on two different bodies");
  if (e.road.size() == 1) return fail("'road' needs at least two points, [x, height]; without it the road is flat");
  if (e.road.size() > PiecewiseLinear::k_most_points) return fail("'road' may have at most 65536 points");
  for (std::size_t i = 1; i < e.road.size(); ++i)
    if (!(e.road[i].x() > e.road[i - 1].x()))
      return fail("the first column of 'road' must increase from row to row: " + rounded_text(e.road[i].x()) + " m follows " +
                  rounded_text(e.road[i - 1].x()) + " m");
  return true;
}

// Returns true if the wheel touches the road at one point everywhere; reports an error otherwise.
bool fits(const Road& road, double radius, SystemBuilder& builder) {
  if (!(road.hollowest() * radius >= 1.0)) return true;
  builder.error("the smooth curve through 'road' has a hollow at x = " + rounded_text(road.hollowest_at()) + " m with a radius of " +
                rounded_text(1.0 / road.hollowest()) + " m, in which a wheel of " + rounded_text(radius) +
                " m would touch it twice: give more points where the road bends, a gentler road, or edges by segment_contact");
  return false;
}

void add_channels(const TyreGroup& group, int i, SystemBuilder& builder) {
  const double radius = group.entries[static_cast<std::size_t>(i)].press.offset;
  builder.add_channel("gap", "m", {"distance of the wheel from the road", "negative while it presses"},
                      [&group, i, radius](const Snapshot& s) { return group.measured(i, *s.evaluation).gap.value - radius; });
  builder.add_channel("rate", "m/s", {"of the gap", "positive: it opens"},
                      [&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).gap.rate; });
  builder.add_channel("force", "N", {"normal force, zero while open", "positive: it presses"},
                      [&group, i](const Snapshot& s) { return group.normal_force(i, *s.evaluation); });
  builder.add_channel("friction", "N", {"force of the tread on the wheel", "positive: along the road's x"},
                      [&group, i](const Snapshot& s) { return -group.tread_state(i, *s.evaluation).force; });
  builder.add_channel("capacity", "N", {"largest force of the tread", "never negative"},
                      [&group, i](const Snapshot& s) { return group.tread_state(i, *s.evaluation).most; });
  const auto share = [&group, i](const Snapshot& s) {
    const auto tread = group.tread_state(i, *s.evaluation);
    return tread.most > 0.0 ? std::min(1.0, std::abs(tread.force) / tread.most) : 0.0;
  };
  Channel& channel = builder.add_channel(
      "share", "", {"force of the tread over the largest at the same instant; 1 where it slides", "never negative"}, share);
  channel.role = ChannelRole::friction_use;
  channel.bounds = [share](const Snapshot& s) { return ValueBounds{0.0, share(s)}; };
  builder.add_channel("slip_rate", "m/s", {"velocity of the tread's ground against the road", "positive: along the road's x"},
                      [&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).slip_rate; });
  builder.add_channel("bent", "m", {"mean deflection of the bristles", "positive: the tread is ahead along the road's x"},
                      [&group, i](const Snapshot& s) { return group.tread_state(i, *s.evaluation).bent; });
  builder.add_channel("mode", "", {"what the tread does", "", "0 in the air, 1 adheres, 2 slides"}, [&group, i](const Snapshot& s) {
    const UnitMode mode = s.evaluation->mode[group.entries[static_cast<std::size_t>(i)].unit];
    return tyre_presses(mode) ? (tread_slides(mode) ? 2.0 : 1.0) : 0.0;
  });
}

void compile_tyre(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Tyre&>(element);
  if (!check(e, builder)) return;
  auto road = std::make_shared<const Road>(e.road.empty() ? Road() : Road(e.road));
  if (!fits(*road, e.radius, builder)) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  TyreGroup::ElementData entry;
  entry.a = a.body;
  entry.b = b.body;
  entry.measure = {a.point, b.point, builder.direction(b, {1.0, 0.0}), e.radius, std::move(road)};
  entry.press = {e.stiffness, e.damping, e.radius};
  entry.tread = {e.friction, e.slip_stiffness / e.relaxation_length, e.tread_damping, e.relaxation_length};
  TyreGroup& group = builder.group<TyreGroup>();
  entry.inner = builder.add_inner(group, entry.measure.at(builder.reference(a.body), builder.reference(b.body)).tread.value);
  group.entries.push_back(std::move(entry));
  builder.add_unit(group, TyreGroup::k_event_count);
  group.entries.back().contact = builder.add_contact(group.entries.back().unit);
  builder.add_endless_face(group.entries.back().contact, a.body, {a.point}, e.b, k_up,
                           "give the part that carries the wheel its whole outline");
  add_channels(group, static_cast<int>(group.entries.size()) - 1, builder);
}

ContactDescription describe(const Element& element, const Model& model) {
  const auto& e = static_cast<const Tyre&>(element);
  ContactDescription contact;
  contact.a = e.a;
  contact.b = e.b;
  contact.opening_ends_slip = true; // contact and tread are one friction element, which ends with the contact
  contact.depth_limit = std::min(e.radius, thickness_behind(model, e.b, k_up).value_or(e.radius));
  contact.points = [](const Element& wheel, const ScenePose& pose) {
    const auto& of = static_cast<const Tyre&>(wheel);
    const ScenePose::PlacedMarker centre = pose.marker(of.a), road = pose.marker(of.b);
    const Vec2 on_road = rotated(centre.point - road.point, -road.angle);
    const double slope = of.road.empty() ? 0.0 : Road(of.road).nearest(on_road.x(), on_road.y()).slope;
    const Vec2 normal = rotated(Vec2(-slope, 1.0).normalized(), road.angle);
    return std::vector<ContactPoint>{{centre.point - of.radius * normal, normal}};
  };
  return contact;
}

} // namespace

const ElementKind& tyre_kind() {
  static const ElementKind kind = [] {
    using T = Tyre;
    ElementKind k;
    k.name = "tyre";
    k.doc = "A wheel with a tyre on a road, seen from the side: presses and lifts off, rolls with slip, sticks exactly at standstill, "
            "slides where it would take more than friction gives.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the wheel: it turns with this marker's body");
    f.add("b", &T::b).as(FieldType::marker).doc("marker in whose axes the road is given");
    f.add("radius", &T::radius).in("m").positive().required().doc("of the wheel");
    f.add("road", &T::road)
        .in("m", "m")
        .doc("[x, height] of points of the road, joined by a smooth curve, straight beyond its ends; default: flat at height 0");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("k, along the road's normal");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("c, along the road's normal");
    f.add("friction", &T::friction).not_negative().required().doc("mu, of the tread on the road");
    f.add("slip_stiffness", &T::slip_stiffness).in("N").positive().required().doc("C: force of the tread over its slip, for small slips");
    f.add("relaxation_length", &T::relaxation_length)
        .in("m")
        .positive()
        .required()
        .doc("sigma: way over which the force follows the slip; at standstill the tread is a spring C/sigma");
    f.add("tread_damping", &T::tread_damping).in("N s/m").positive().required().doc("b, of the bristles, parallel to their spring");
    k.example = R"([[element]]
name = 'wheel'
kind = 'tyre'
a = 'a'
b = { body = 'b', point = [0.0, 1.5] }
radius = 0.5
stiffness = 2e5
friction = 0.8
slip_stiffness = 5e4
relaxation_length = 0.2
tread_damping = 500.0
)";
    k.holds<T>();
    k.compile = compile_tyre;
    k.contact = describe;
    return k;
  }();
  return kind;
}

} // namespace steplap
