#include "elements/unilateral_contact.h"

#include "elements/contact_laws.h"
#include "elements/ended_contact.h"
#include "elements/pad.h"
#include "elements/restitution.h"
#include "mbd/base/portable_math.h"
#include "mbd/system/contact_description.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

namespace steplap {

namespace {

template <class Measure, class Law>
LawGroup<Measure, Law>& add(const ContactGeometry& g, const Measure& measure, const Law& law, SystemBuilder& builder) {
  using Group = LawGroup<Measure, Law>;
  Group& group = builder.group<Group>();
  group.entries.push_back({g.a, g.b, measure, law});
  builder.add_unit(group, Law::k_event_count);
  group.entries.back().contact = builder.add_contact(group.entries.back().unit);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("gap", "m", {"distance that is left", "negative while it presses"},
                      motion_value(g.a, g.b, measure, [offset = law.offset](const auto& m) { return m.value - offset; }));
  builder.add_channel("rate", "m/s", {"of the gap", "positive: it opens"},
                      motion_value(g.a, g.b, measure, [](const auto& m) { return m.rate; }));
  builder.add_channel("force", "N", {"normal force, zero while open", "positive: it presses"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
  return group;
}

GivenDamper damper_of(const UnilateralContact& e) { return {static_cast<double>(e.count) * e.damping, stiffness_of(e), e.restitution}; }

// Sets the damping of the contact added last to `group`.
template <class Group> void damp(Group& group, const UnilateralContact& e, const ContactGeometry& g, SystemBuilder& builder) {
  const auto put = [](KelvinVoigtContact& law, double c) { law.c = c; };
  set_damping_from_restitution(group, damper_of(e), g.a, g.b, g.gap, builder, put);
}

template <class Law> EndedContactGroup<Law>& add_ended(const ContactGeometry& g, const Vec2& ends, const Law& law, SystemBuilder& builder) {
  using Group = EndedContactGroup<Law>;
  Group& group = builder.group<Group>();
  typename Group::ElementData entry;
  entry.a = g.a;
  entry.b = g.b;
  entry.gap = g.gap;
  entry.law = law;
  entry.low = ends.x();
  entry.high = ends.y();
  const bool is_off = entry.is_off_at(builder.reference(g.a), builder.reference(g.b));
  entry.inner = builder.add_inner(group, is_off ? 1.0 : 0.0);
  group.entries.push_back(entry);
  builder.add_unit(group, Group::k_event_count);
  group.entries.back().contact = builder.add_contact(group.entries.back().unit);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("gap", "m", "δ, negative while closed or off",
                      motion_value(g.a, g.b, g.gap, [offset = law.offset](const auto& m) { return m.value - offset; }));
  builder.add_channel("rate", "m/s", "of the gap", motion_value(g.a, g.b, g.gap, [](const auto& m) { return m.rate; }));
  builder.add_channel("force", "N", "normal force, positive in compression",
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
  builder.add_channel("along", "m", "place of the foot along the face, from marker b",
                      motion_value(g.a, g.b, entry.slide(), [](const auto& m) { return m.value; }));
  return group;
}

bool check(const UnilateralContact& e, SystemBuilder& builder) {
  const int given = e.preload.has_value() + e.interference.has_value() + e.gap.has_value();
  bool is_bad = false;
  const auto fail = [&](const std::string& message) {
    builder.error(message);
    is_bad = true;
  };
  const std::string problem = pad_of(e).problem(e.stiffness.has_value());
  if (!problem.empty()) fail(problem);
  else if (!e.stiffness && e.material.empty()) fail("needs 'stiffness', or a pad by 'material', 'area' and 'thickness'");
  if (!e.material.empty() && e.exponent != 1.0) fail("a pad by 'material' has a linear stiffness: leave 'exponent' out");
  if (given > 1) fail("give one of 'preload', 'interference' and 'gap'");
  if (e.normal.norm() == 0.0) fail("'normal' has no direction");
  if (e.axis && e.axis->norm() == 0.0) fail("'axis' has no direction");
  if (e.law == "hunt_crossley" && e.damping != 0.0) fail("Hunt-Crossley takes 'dissipation' instead of 'damping'");
  if (e.restitution && e.damping != 0.0) fail("give 'damping' or 'restitution', not both");
  if (e.restitution && e.law != "kelvin_voigt")
    fail("'restitution' is of law = \"kelvin_voigt\", whose rebound does not depend on the speed");
  if (e.law != "hunt_crossley" && (e.exponent != 1.0 || e.dissipation != 0.0))
    fail("'exponent' and 'dissipation' belong to law = \"hunt_crossley\"");
  if (e.ends && !(e.ends->x() < e.ends->y())) fail("'ends' are the lower and the higher end: the first must be less");
  return !is_bad;
}

ContactDescription describe(const Element& element, const Model& model) {
  const auto& e = static_cast<const UnilateralContact&>(element);
  ContactDescription contact;
  contact.a = e.a;
  contact.b = e.b;
  contact.standing = ContactDescription::Standing::a;
  contact.is_preloaded = e.preload || e.interference;
  contact.has_ends = e.ends.has_value();
  if (!e.ends) contact.depth_limit = thickness_behind(model, e.b, e.normal); // beyond the end of a face a penetration has no limit
  contact.points = [](const Element& foot, const ScenePose& pose) {
    const auto& of = static_cast<const UnilateralContact&>(foot);
    return std::vector<ContactPoint>{{pose.marker(of.a).point, rotated(of.normal, pose.marker(of.b).angle).normalized()}};
  };
  return contact;
}

// Adds the contact, with its law, to the builder.
void add_contact(const UnilateralContact& e, SystemBuilder& builder) {
  const ContactGeometry g = contact_geometry(e, builder);
  const Motion<double>&a = builder.reference(g.a), &b = builder.reference(g.b);
  if (g.gap.is_axis_in_a) {
    const Pair<double> normal = to_ground(b, g.gap.normal), axis = to_ground(a, g.gap.axis);
    if (!(dot(normal, axis) > 0.0)) return builder.error("the contact axis must point away from the line: normal · axis > 0 is required");
  }
  const double now = g.gap.at<false, double>(a, b).value;
  const double k = stiffness_of(e);
  double offset = 0.0;
  if (e.gap) offset = now - *e.gap;
  if (e.interference) offset = now + *e.interference;
  if (e.preload) offset = now + portable::pow(*e.preload / k, 1.0 / e.exponent);
  const double c = static_cast<double>(e.count) * e.damping; // a restitution sets it when the joints are known
  const KelvinVoigtContact kelvin_voigt{k, c, offset};
  if (e.ends) {
    if (e.law == "literal") add_ended(g, *e.ends, AdhesiveKelvinVoigtContact{k, c, offset}, builder);
    else if (e.law == "hunt_crossley") add_ended(g, *e.ends, HuntCrossleyContact{k, e.exponent, e.dissipation, offset}, builder);
    else damp(add_ended(g, *e.ends, kelvin_voigt, builder), e, g, builder);
    return;
  }
  if (e.law == "literal") add(g, g.gap, AdhesiveKelvinVoigtContact{k, c, offset}, builder);
  else if (e.law == "hunt_crossley") add(g, g.gap, HuntCrossleyContact{k, e.exponent, e.dissipation, offset}, builder);
  else if (g.gap.is_axis_in_a) damp(add(g, g.gap, kelvin_voigt, builder), e, g, builder);
  else // the force along n has the same line of action through p_A as through the tip
    with_cheapest(AxisMeasure{g.gap.point_a, g.gap.point_b, g.gap.normal},
                  [&](const auto& measure) { damp(add(g, measure, kelvin_voigt, builder), e, g, builder); });
}

void compile_contact(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const UnilateralContact&>(element);
  if (!check(e, builder)) return;
  add_contact(e, builder);
  const ContactIndex* const contact = builder.contact(e.name);
  if (e.ends || !contact) return;
  const CompiledMarker a = builder.marker(e.a);
  builder.add_endless_face(contact->force, a.body, {a.point}, e.b, e.normal, "give it 'ends', or take a polygon_contact");
}

} // namespace

double stiffness_of(const UnilateralContact& contact) {
  return static_cast<double>(contact.count) * (contact.material.empty() ? contact.stiffness.value_or(0.0) : pad_of(contact).stiffness());
}

ContactGeometry contact_geometry(const UnilateralContact& contact, const SystemBuilder& builder) {
  const CompiledMarker a = builder.marker(contact.a), b = builder.marker(contact.b);
  ContactGeometry g;
  g.a = a.body;
  g.b = b.body;
  g.gap.point_a = a.point;
  g.gap.point_b = b.point;
  g.gap.normal = builder.direction(b, contact.normal);
  g.gap.is_axis_in_a = contact.axis.has_value();
  if (contact.axis) g.gap.axis = builder.direction(a, *contact.axis);
  return g;
}

double damping_of(const UnilateralContact& contact, const ContactGeometry& geometry, SystemBuilder& builder) {
  return contact_damping(damper_of(contact), geometry.a, geometry.b, geometry.gap, builder);
}

const ElementKind& unilateral_contact_kind() {
  static const ElementKind kind = [] {
    using T = UnilateralContact;
    ElementKind k;
    k.name = "unilateral_contact";
    k.doc = "A marker on a against a line through marker b, endless or with ends: it presses, it never holds. Closed while the gap "
            "is negative; the normal force is positive in compression.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker that touches");
    f.add("b", &T::b).as(FieldType::marker).doc("marker on the line");
    f.add("normal", &T::normal).doc("normal of the line in marker b's axes, towards a");
    f.add("axis", &T::axis).doc("contact axis in marker a's axes; default: the normal");
    f.add("law", &T::law)
        .one_of({"kelvin_voigt", "literal", "hunt_crossley"})
        .doc("kelvin_voigt: max(0, -k d - c d'); literal: -k d - c d', may pull; hunt_crossley");
    f.add("stiffness", &T::stiffness).in("N/m").positive().doc("k of one element (Hunt-Crossley: per m^exponent)");
    add_pad_fields<T>(f);
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("c of one element");
    f.add("restitution", &T::restitution)
        .positive()
        .at_most(1.0)
        .doc("instead of damping: speed after a blow over that before it, of its bodies with the joints that hold them, in the reference "
             "pose");
    f.add("exponent", &T::exponent).positive().doc("Hunt-Crossley: power of the depth");
    f.add("dissipation", &T::dissipation).in("s/m").not_negative().doc("Hunt-Crossley: factor 1 - alpha d'");
    f.add("count", &T::count).at_least(1).doc("equal elements side by side");
    f.add("preload", &T::preload).in("N").not_negative().doc("force of all in the reference pose");
    f.add("interference", &T::interference).in("m").not_negative().doc("depth in the reference pose");
    f.add("gap", &T::gap).in("m").not_negative().doc("gap in the reference pose");
    f.add("ends", &T::ends)
        .in("m")
        .doc("where the face ends, [low, high] along (n_y, -n_x) from marker b; beyond it nothing is carried; default: endless");
    k.example = R"([[element]]
name = 'foot'
kind = 'unilateral_contact'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
stiffness = 1e6
damping = 1e4
)";
    k.holds<T>();
    k.compile = compile_contact;
    k.contact = describe;
    return k;
  }();
  return kind;
}

} // namespace steplap
