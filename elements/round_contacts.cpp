#include "elements/round_contacts.h"

#include "elements/contact_laws.h"
#include "elements/restitution.h"
#include "elements/round_measures.h"
#include "mbd/system/contact_description.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <algorithm>

namespace steplap {

namespace {

template <class Measure, class Law>
LawGroup<Measure, Law>& add(int a, int b, const Measure& measure, const Law& law, SystemBuilder& builder) {
  using Group = LawGroup<Measure, Law>;
  Group& group = builder.group<Group>();
  group.entries.push_back({a, b, measure, law});
  builder.add_unit(group, Law::k_event_count);
  group.entries.back().contact = builder.add_contact(group.entries.back().unit);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("gap", "m", {"distance that is left", "negative while it presses"},
                      motion_value(a, b, measure, [offset = law.offset](const auto& m) { return m.value - offset; }));
  builder.add_channel("rate", "m/s", {"of the gap", "positive: it opens"},
                      motion_value(a, b, measure, [](const auto& m) { return m.rate; }));
  builder.add_channel("force", "N", {"normal force, zero while open", "positive: it presses"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
  return group;
}

template <class Measure>
void add_with_law(const RoundContact& e, int a, int b, const Measure& measure, double offset, SystemBuilder& builder) {
  if (e.law == "hunt_crossley") {
    add(a, b, measure, HuntCrossleyContact{e.stiffness, e.exponent, e.dissipation, offset}, builder);
    return;
  }
  auto& group = add(a, b, measure, KelvinVoigtContact{e.stiffness, e.damping, offset}, builder);
  const auto put = [](KelvinVoigtContact& law, double c) { law.c = c; };
  set_damping_from_restitution(group, {e.damping, e.stiffness, e.restitution}, a, b, measure, builder, put);
}

bool check(const RoundContact& e, SystemBuilder& builder) {
  bool is_bad = false;
  const auto fail = [&](const char* message) {
    builder.error(message);
    is_bad = true;
  };
  if (builder.marker(e.a).body == builder.marker(e.b).body) fail("touches its own body: name markers on two different bodies");
  if (e.law == "hunt_crossley" && e.damping != 0.0) fail("Hunt-Crossley takes 'dissipation' instead of 'damping'");
  if (e.restitution && e.damping != 0.0) fail("give 'damping' or 'restitution', not both");
  if (e.restitution && e.law != "kelvin_voigt")
    fail("'restitution' is of law = \"kelvin_voigt\", whose rebound does not depend on the speed");
  if (e.law != "hunt_crossley" && (e.exponent != 1.0 || e.dissipation != 0.0))
    fail("'exponent' and 'dissipation' belong to law = \"hunt_crossley\"");
  return !is_bad;
}

ContactDescription describe_circle(const Element& element, const Model&) {
  const auto& e = static_cast<const CircleContact&>(element);
  ContactDescription contact;
  contact.a = e.a;
  contact.b = e.b;
  // Limit of the penetration, at which the direction between the circles is lost.
  if (!e.inside) contact.depth_limit = e.radius_a + e.radius_b;
  contact.points = [](const Element& circle, const ScenePose& pose) {
    const auto& of = static_cast<const CircleContact&>(circle);
    const Vec2 a = pose.marker(of.a).point, b = pose.marker(of.b).point;
    if (a == b) return std::vector<ContactPoint>{};
    const Vec2 outwards = (a - b).normalized(), normal = of.inside ? Vec2(-outwards) : outwards;
    return std::vector<ContactPoint>{{a - of.radius_a * normal, normal}};
  };
  return contact;
}

ContactDescription describe_segment(const Element& element, const Model&) {
  const auto& e = static_cast<const SegmentContact&>(element);
  ContactDescription contact;
  contact.a = e.a;
  contact.b = e.b;
  contact.depth_limit = e.radius + 0.5 * e.thickness;
  contact.points = [](const Element& segment, const ScenePose& pose) {
    const auto& of = static_cast<const SegmentContact&>(segment);
    const Vec2 a = pose.marker(of.a).point;
    const ScenePose::PlacedMarker b = pose.marker(of.b);
    const Vec2 from = b.point + rotated(of.from, b.angle), along = b.point + rotated(of.to, b.angle) - from;
    const double share = std::clamp((a - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vec2 normal = (a - from - share * along).normalized();
    return std::vector<ContactPoint>{{a - of.radius * normal, normal}};
  };
  return contact;
}

void compile_circle(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const CircleContact&>(element);
  if (!check(e, builder)) return;
  if (!(e.radius_a + e.radius_b > 0.0)) return builder.error("one of 'radius_a' and 'radius_b' must be greater than 0 m");
  if (e.inside && e.radius_b <= e.radius_a)
    return builder.error("with inside = true 'radius_b', the ring's, must be greater than 'radius_a'");
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (e.inside) add_with_law(e, a.body, b.body, InsideMeasure{a.point, b.point}, e.radius_a - e.radius_b, builder);
  else add_with_law(e, a.body, b.body, DistanceMeasure{a.point, b.point}, e.radius_a + e.radius_b, builder);
}

void compile_segment(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const SegmentContact&>(element);
  if (!check(e, builder)) return;
  if (!((e.to - e.from).norm() > 0.0)) return builder.error("'from' and 'to' are the same point");
  const double reach = e.radius + 0.5 * e.thickness;
  if (!(reach > 0.0))
    return builder.error("a point against a line without thickness has no depth to press in: give 'radius' or "
                         "'thickness'");
  add_with_law(e, builder.marker(e.a).body, builder.marker(e.b).body, segment_measure(e, builder), reach, builder);
}

RowSpec roll_row(const RoundContact& e, const SystemBuilder& builder) {
  RowSpec row;
  row.a = builder.marker(e.a).body;
  row.b = builder.marker(e.b).body;
  row.point_a = builder.marker(e.a).point;
  row.point_b = builder.marker(e.b).point;
  row.quantity = "roll";
  return row;
}

// Returns the unit vector from marker b to marker a in the reference pose, in the frame of body b; (1, 0) if they coincide.
Vec2 start_of(const RowSpec& row, const SystemBuilder& builder) {
  const Motion<double>&a = builder.reference(row.a), &b = builder.reference(row.b);
  const Vec2 centre = Vec2(a.x - b.x, a.y - b.y) + rotated(row.point_a, a.theta);
  const Vec2 start = rotated(centre, -b.theta) - row.point_b;
  return start.norm() > 0.0 ? Vec2(start.normalized()) : Vec2(1.0, 0.0);
}

std::vector<RowSpec> circle_rows(const CircleContact& e, const SystemBuilder& builder) {
  RowSpec row = roll_row(e, builder);
  row.kind = MeasureKind::roll_round;
  row.radius_a = e.inside ? -e.radius_a : e.radius_a;
  row.radius_b = e.radius_b;
  row.direction = start_of(row, builder);
  return {row};
}

std::vector<RowSpec> segment_rows(const SegmentContact& e, const SystemBuilder& builder) {
  const SegmentMeasure segment = segment_measure(e, builder);
  const Vec2 normal = perp(segment.tangent);
  std::vector<RowSpec> rows(4, roll_row(e, builder));
  for (int side = 0; side < 2; ++side) {
    rows[side].kind = MeasureKind::roll_line;
    rows[side].point_b = segment.from;
    rows[side].direction = side == 0 ? normal : Vec2(-normal);
    rows[side].radius_a = e.radius;
  }
  for (int end = 2; end < 4; ++end) {
    rows[end].kind = MeasureKind::roll_round;
    rows[end].point_b = end == 2 ? segment.from : segment.to();
    rows[end].direction = end == 2 ? Vec2(-segment.tangent) : segment.tangent;
    rows[end].radius_a = e.radius;
    rows[end].radius_b = 0.5 * e.thickness;
  }
  return rows;
}

template <class T> void add_fields(FieldTable& f) {
  f.add("law", &T::law).one_of({"kelvin_voigt", "hunt_crossley"}).doc("kelvin_voigt: max(0, -k d - c d'); hunt_crossley");
  f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("k (Hunt-Crossley: per m^exponent)");
  f.add("damping", &T::damping).in("N s/m").not_negative().doc("c");
  f.add("restitution", &T::restitution)
      .positive()
      .at_most(1.0)
      .doc("instead of damping: speed after a blow over that before it, of its bodies with the joints that hold them, in the reference "
           "pose");
  f.add("exponent", &T::exponent).positive().doc("Hunt-Crossley: power of the depth");
  f.add("dissipation", &T::dissipation).in("s/m").not_negative().doc("Hunt-Crossley: factor 1 - alpha d'");
}

} // namespace

SegmentMeasure segment_measure(const SegmentContact& e, const SystemBuilder& builder) {
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  const Vec2 along = e.to - e.from;
  return {a.point, b.point + rotated(e.from, b.angle), builder.direction(b, along), along.norm()};
}

std::vector<RowSpec> rolling_rows(const Element& element, const SystemBuilder& builder) {
  if (const auto* circle = dynamic_cast<const CircleContact*>(&element)) return circle_rows(*circle, builder);
  if (const auto* segment = dynamic_cast<const SegmentContact*>(&element)) return segment_rows(*segment, builder);
  return {};
}

const ElementKind& circle_contact_kind() {
  static const ElementKind kind = [] {
    using T = CircleContact;
    ElementKind k;
    k.name = "circle_contact";
    k.doc = "A circle of a against a circle of b, outside or inside it: rollers, balls, a pin in its hole. They "
            "press, they never hold.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the first circle");
    f.add("b", &T::b).as(FieldType::marker).doc("centre of the second circle");
    f.add("radius_a", &T::radius_a).in("m").not_negative().doc("of the first circle; 0: a point");
    f.add("radius_b", &T::radius_b).in("m").not_negative().doc("of the second circle; 0: a point");
    f.add("inside", &T::inside).doc("true: the first circle is inside the second, a ring");
    add_fields<T>(f);
    k.example = R"([[element]]
name = 'rollers'
kind = 'circle_contact'
a = 'a'
b = 'b'
radius_a = 1.0
radius_b = 1.0
stiffness = 1e6
)";
    k.holds<T>();
    k.compile = compile_circle;
    k.contact = describe_circle;
    return k;
  }();
  return kind;
}

const ElementKind& segment_contact_kind() {
  static const ElementKind kind = [] {
    using T = SegmentContact;
    ElementKind k;
    k.name = "segment_contact";
    k.doc = "A circle (or point) of a against a line segment of b: both of its sides and its ends, which are round "
            "by half of its thickness. They press, they never hold.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the circle, or the point");
    f.add("b", &T::b).as(FieldType::marker).doc("marker in whose axes the segment is given");
    f.add("radius", &T::radius).in("m").not_negative().doc("of the circle; 0: a point");
    f.add("from", &T::from).in("m").required().doc("one end of the segment's middle line");
    f.add("to", &T::to).in("m").required().doc("the other end");
    f.add("thickness", &T::thickness).in("m").not_negative().doc("of the segment; its ends are half circles");
    add_fields<T>(f);
    k.example = R"([[element]]
name = 'roller on a plate'
kind = 'segment_contact'
a = 'a'
b = 'b'
radius = 0.5
from = [-1.5, 1.5]
to = [1.5, 1.5]
stiffness = 1e6
)";
    k.holds<T>();
    k.compile = compile_segment;
    k.contact = describe_segment;
    return k;
  }();
  return kind;
}

} // namespace steplap
