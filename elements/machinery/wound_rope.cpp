#include "elements/machinery/wound_rope.h"

#include "elements/contact_laws.h"
#include "elements/machinery/wound_measure.h"
#include "mbd/base/dual.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

#include <cmath>

namespace steplap {

namespace {

// Smallest length of the straight part, relative to that in the reference pose; equal to that of ropes.
constexpr double k_shortest = 1e-6;

class WoundRopeGroup final : public ForceGroup {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    WoundMeasure measure;
    KelvinVoigtContact law;
    std::string name;
    double shortest = 0.0; ///< smallest length of the straight part, m; below it the part has vanished, and its direction is rounding
    int unit = 0, first_event = 0;
  };
  std::vector<ElementData> entries;

  [[nodiscard]] static MeasureValue<double> measured(const ElementData& entry, const Motion<double>* motion) {
    return entry.measure.at<false, double>(motion[entry.a], motion[entry.b]);
  }
  [[nodiscard]] double tension(int i, const Evaluation& e) const {
    const auto m = measured(entries[i], e.motion);
    return entries[i].law.force(m.value, m.rate, e.mode[entries[i].unit]);
  }

  void add_forces(Evaluation& e) const override {
    for (const ElementData& entry : entries) {
      const auto part = entry.measure.straight(e.motion[entry.a], e.motion[entry.b]);
      const auto m = entry.measure.along(part, e.motion[entry.a], e.motion[entry.b]);
      check(entry, part);
      const UnitMode mode = e.mode[entry.unit];
      const double f = entry.law.force(m.value, m.rate, mode);
      entry.law.event_value(m.value, m.rate, mode, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
      e.dissipation += (entry.law.elastic_force(m.value, mode) - f) * m.rate;
      if (f == 0.0) continue;
      add_at(e.force[entry.a], m.lever_a, f * m.direction);
      add_at(e.force[entry.b], m.lever_b, -f * m.direction);
    }
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) sum += entry.law.energy(measured(entry, motion).value);
    return sum;
  }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries)
      add_pair_jacobian(
          entry.a, entry.b, entry.measure, e,
          [&](const Dual<12>& value, const Dual<12>& rate) { return entry.law.force(value, rate, e.mode[entry.unit]); }, out);
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) turns.add(entry.a, entry.b, turning_of(entry.measure));
  }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    const auto m = measured(entries[element], e.motion);
    return entries[element].law.initial_mode(m.value, m.rate);
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const ElementData& entry = entries[element];
    const auto m = measured(entry, e.motion);
    return entry.law.next_mode(mode, slot, m.value, m.rate, rounding_of(entry, m, e));
  }
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const ElementData& entry = entries[element];
    const auto m = measured(entry, e.motion);
    return entry.law.is_armed_at_entry(mode, slot, m.value, rounding_of(entry, m, e));
  }
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override {
    if (to == k_contact_open) return EventKind::enters_gap;
    return from == k_contact_open ? EventKind::closes_gap : KelvinVoigtContact::event_kind(from, to);
  }

private:
  // Includes the rounding error of the wound length, in addition to those of the measure's terms.
  static double rounding_of(const ElementData& entry, const MeasureValue<double>& m, const Evaluation& e) {
    const Motion<double>&a = e.motion[entry.a], &b = e.motion[entry.b];
    const double wound =
        std::abs(entry.measure.taken) + std::abs(entry.measure.radius_a * a.theta) + std::abs(entry.measure.radius_b * b.theta);
    return value_rounding(m, a, b) + k_rounded_sum * wound;
  }
  static void add_at(BodyForce& sum, const Pair<double>& lever, const Pair<double>& force) {
    sum.fx += force.x;
    sum.fy += force.y;
    sum.m += cross(lever, force);
  }
  static void check(const ElementData& entry, const WoundMeasure::Straight<double>& part) {
    const WoundMeasure& measure = entry.measure;
    if (part.length < entry.shortest)
      throw ElementFailure("the load on wound_rope '" + entry.name + "' has run onto its wheel: add a limit that stops it before",
                           {entry.name});
    if (measure.radius_a + measure.radius_b == 0.0 || !(std::abs(measure.turned(part.u)) > k_most_turned)) return;
    throw ElementFailure("wound_rope '" + entry.name + "' has turned by half a turn against the reference pose: so far it is not followed",
                         {entry.name});
  }
};

// Checks that the distance of the centres allows a tangent.
bool has_tangent(const WoundRope& e, const CompiledMarker& a, const CompiledMarker& b, SystemBuilder& builder) {
  const double apart = (builder.marker_position(b) - builder.marker_position(a)).norm(), c = std::abs(e.radius_a + e.radius_b);
  if (apart > c && apart > 1e-12) return true;
  builder.error("its wheels' centres are " + rounded_text(apart) + " m apart, but a straight part of rope between them takes more than " +
                rounded_text(c) + " m");
  return false;
}

void compile_wound_rope(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const WoundRope&>(element);
  if (e.pretension && e.slack) return builder.error("give either 'pretension' or 'slack'");
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body with itself: name markers on two different bodies");
  if (!has_tangent(e, a, b, builder)) return;
  WoundRopeGroup& group = builder.group<WoundRopeGroup>();
  WoundRopeGroup::ElementData entry{a.body, b.body, {a.point, b.point, e.radius_a, e.radius_b}, {}, e.name};
  const Motion<double>&at_a = builder.reference(a.body), &at_b = builder.reference(b.body);
  const auto part = entry.measure.straight(at_a, at_b);
  entry.measure.start = {part.u.x, part.u.y};
  entry.shortest = k_shortest * part.length;
  entry.measure.taken = -entry.measure.at<false, double>(at_a, at_b).value;
  const double free = e.slack.value_or(0.0) - e.pretension.value_or(0.0) / e.stiffness;
  entry.law = {e.stiffness, e.damping, -free};
  const WoundMeasure measure = entry.measure;
  group.entries.push_back(std::move(entry));
  builder.add_unit(group, KelvinVoigtContact::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("length", "m", "length of its straight part",
                      MotionValue{[measure, a = a.body, b = b.body](const Motion<double>* motion) {
                        return measure.straight(motion[a], motion[b]).length;
                      }});
  builder.add_channel("stretch", "m", {"by which it is longer than without load", "negative: slack"},
                      motion_value(a.body, b.body, measure, [free](const auto& m) { return -m.value - free; }));
  builder.add_channel("rate", "m/s", {"of its stretch", "positive: it grows"},
                      motion_value(a.body, b.body, measure, [](const auto& m) { return -m.rate; }));
  builder.add_channel("tension", "N", {"force along it, zero while it is slack", "positive: it pulls"},
                      [&group, i](const Snapshot& s) { return group.tension(i, *s.evaluation); });
}

} // namespace

const ElementKind& wound_rope_kind() {
  static const ElementKind kind = [] {
    using T = WoundRope;
    ElementKind k;
    k.name = "wound_rope";
    k.goes_slack = true;
    k.doc = "A rope between two wheels on which its ends are wound, or from a wheel to a point: a hoist's drum, one "
            "side of a belt or "
            "a chain, a rope over a heavy pulley. It pulls, it never pushes, and it does not slip on its wheels.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the first wheel, or a point");
    f.add("b", &T::b).as(FieldType::marker).doc("centre of the second wheel, or a point");
    f.add("radius_a", &T::radius_a)
        .in("m")
        .doc("of the first wheel: positive where turning it counter-clockwise winds the rope up, negative where "
             "turning it clockwise does; 0: a point");
    f.add("radius_b", &T::radius_b).in("m").doc("of the second wheel, likewise");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("of the whole rope; it does not change with what is wound up");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("while it is taut; never pushes");
    f.add("pretension", &T::pretension).in("N").not_negative().doc("in the reference pose");
    f.add("slack", &T::slack).in("m").not_negative().doc("by which it is longer than the way in the reference pose");
    k.example = R"([[element]]
name = 'rope'
kind = 'wound_rope'
a = 'a'
b = 'b'
radius_a = 0.3
radius_b = 0.3
stiffness = 1e6
)";
    k.holds<T>();
    k.compile = compile_wound_rope;
    return k;
  }();
  return kind;
}

} // namespace steplap
