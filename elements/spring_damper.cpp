#include "elements/spring_damper.h"

#include "elements/pad.h"
#include "elements/space_distance.h"
#include "elements/spring_laws.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <cmath>
#include <numbers>

namespace steplap {

namespace {

bool is_increasing(const std::vector<Vec2>& table) {
  for (std::size_t i = 1; i < table.size(); ++i)
    if (!(table[i].x() > table[i - 1].x())) return false;
  return true;
}

// Returns what is wrong with the ways to give stiffness and damping, "" if nothing is.
std::string constants_problem(const SpringDamper& e) {
  const bool has_stiffness = e.stiffness != 0.0 || !e.force_table.empty();
  if (std::string problem = pad_of(e).problem(has_stiffness); !problem.empty()) return problem;
  if (e.carries && !e.frequency && !e.damping_ratio) return "'carries' goes with 'frequency' or 'damping_ratio'";
  if (!e.carries && (e.frequency || e.damping_ratio))
    return "'frequency' and 'damping_ratio' are of a mass on the spring: give it as 'carries'";
  if (e.frequency && (has_stiffness || !e.material.empty())) return "give either 'frequency' or a stiffness, not both";
  if (!e.damping_ratio) return "";
  if (e.damping != 0.0 || !e.damping_table.empty()) return "give either 'damping_ratio' or a damping, not both";
  return constants_of(e).k > 0.0 ? "" : "'damping_ratio' needs 'frequency', 'stiffness' or a pad";
}

// Checks the fields; `free` and `table` are the names of the fields in messages.
bool check(const SpringDamper& e, SystemBuilder& builder, const char* free = "'free_length'", const char* table = "'force_table'") {
  const auto fails = [&builder](bool is_wrong, const auto&... parts) { // a message is composed only where it is needed
    if (is_wrong) builder.error((std::string() + ... + parts));
    return is_wrong;
  };
  bool is_bad = refuses_across(builder, e.axis.has_value(), e.across);
  const std::string problem = constants_problem(e);
  if (fails(!problem.empty(), problem)) return false;
  const SpringConstants constants = constants_of(e);
  is_bad |= fails(e.preload && e.free_length, "give either 'preload' or ", free, ", not both");
  is_bad |= fails(e.preload && *e.preload != 0.0 && constants.k == 0.0, "'preload' needs a 'stiffness'");
  is_bad |= fails(!e.force_table.empty() && e.stiffness != 0.0, "give either 'stiffness' or ", table, ", not both");
  is_bad |= fails(!e.damping_table.empty() && e.damping != 0.0, "give either 'damping' or 'damping_table', not both");
  is_bad |= fails(e.force_table.size() == 1 || e.damping_table.size() == 1, "a table needs at least two points");
  is_bad |=
      fails(!is_increasing(e.force_table) || !is_increasing(e.damping_table), "the first column of a table must increase from row to row");
  is_bad |= fails(e.gap > 0.0 && (!e.force_table.empty() || !e.damping_table.empty()),
                  "'gap' and tables exclude each other: put the dead band into the table");
  is_bad |= fails(std::max(e.force_table.size(), e.damping_table.size()) > PiecewiseLinear::k_most_points,
                  "a table may have at most 65536 points");
  is_bad |= fails(e.between != "lines" && e.force_table.empty() && e.damping_table.empty(),
                  "'between' says how the points of a table are joined: give ", table, " or 'damping_table'");
  is_bad |= fails(constants.k == 0.0 && constants.c == 0.0 && e.force_table.empty() && e.damping_table.empty(),
                  "gives no force: set 'stiffness', 'damping' or a table");
  return !is_bad;
}

// Returns the value of a channel that shows a measure minus `zero`, or its rate. A distance in space is not a row, so formulas of forces
// cannot use it.
template <class Measure>
auto measured_value(std::function<double(const Snapshot&)> shown, int a, int b, const Measure& measure, double zero, bool is_rate) {
  if constexpr (requires { row_of(a, b, measure); }) return MeasuredValue{std::move(shown), row_of(a, b, measure), zero, is_rate};
  else return shown;
}

template <class Measure, class Law> void add(SystemBuilder& builder, int a, int b, const Measure& measure, const Law& law) {
  using Group = LawGroup<Measure, Law>;
  Group& group = builder.group<Group>();
  group.entries.push_back({a, b, measure, law});
  if constexpr (Law::k_event_count > 0) builder.add_unit(group, Law::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  const bool is_angle = std::is_same_v<Measure, AngleMeasure>;
  builder.add_channel(
      "elongation", is_angle ? "rad" : "m", {"its length or angle less the free one", "positive: stretched"},
      measured_value([&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).value - group.entries[i].law.free; }, a, b,
                     measure, law.free, false));
  builder.add_channel(
      "rate", is_angle ? "rad/s" : "m/s", {"of the elongation", "positive: it grows"},
      measured_value([&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).rate; }, a, b, measure, 0.0, true));
  builder.add_channel(is_angle ? "couple" : "force", is_angle ? "N m" : "N",
                      {"what it acts with on a along its axis, away from b", "negative: it pulls a towards b"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
}

template <class Measure> void add_with_law(const SpringDamper& e, SystemBuilder& builder, int a, int b, const Measure& measure) {
  const double n = static_cast<double>(e.count);
  const SpringConstants one = constants_of(e);
  const double k = n * one.k, c = n * one.c;
  const double now = measure.template at<false, double>(builder.reference(a), builder.reference(b)).value;
  double free = e.free_length.value_or(now);
  if (e.preload && k > 0.0) free = now + *e.preload / k;
  if (!e.force_table.empty() || !e.damping_table.empty()) {
    auto spring = e.force_table, damper = e.damping_table;
    if (spring.empty()) spring = {{-1.0, -one.k}, {1.0, one.k}};
    if (damper.empty()) damper = {{-1.0, -one.c}, {1.0, one.c}};
    if (e.between == "curve") add(builder, a, b, measure, SmoothSpring{SmoothCurve(spring), SmoothCurve(damper), free, n});
    else add(builder, a, b, measure, TabulatedSpring{PiecewiseLinear(spring), PiecewiseLinear(damper), free, n});
  } else if (e.gap > 0.0) {
    add(builder, a, b, measure, GapSpring{k, c, free, 0.5 * e.gap});
  } else if constexpr (std::is_same_v<Measure, AxisMeasure>) {
    with_cheapest(measure, [&](const auto& m) { add(builder, a, b, m, LinearSpring{k, c, free}); });
  } else {
    add(builder, a, b, measure, LinearSpring{k, c, free});
  }
}

void compile_spring_damper(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const SpringDamper&>(element);
  if (!check(e, builder)) return;
  if (!e.axis && e.free_length.value_or(0.0) < 0.0)
    return builder.error("'free_length' must not be negative from point to point: a distance never is");
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (e.axis) {
    if (e.axis->norm() == 0.0) return builder.error("'axis' has no direction");
    return add_with_law(e, builder, a.body, b.body, AxisMeasure{a.point, b.point, builder.direction(b, *e.axis)});
  }
  with_distance(builder, a, b, e.across, [&](const auto& measure) { add_with_law(e, builder, a.body, b.body, measure); });
}

void compile_rotational(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const RotationalSpringDamper&>(element);
  SpringDamper same; // checked as a spring along a coordinate, with the same values
  same.stiffness = e.stiffness;
  same.damping = e.damping;
  same.free_length = e.free_angle;
  same.preload = e.preload;
  same.gap = e.gap;
  same.force_table = e.couple_table;
  same.damping_table = e.damping_table;
  same.between = e.between;
  same.count = e.count;
  if (!check(same, builder, "'free_angle'", "'couple_table'")) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (same.free_length) *same.free_length += b.angle - a.angle; // it is of the markers' axes, the measure of the bodies'
  add_with_law(same, builder, a.body, b.body, AngleMeasure{});
}

} // namespace

SpringConstants constants_of(const SpringDamper& spring) {
  const double n = static_cast<double>(spring.count);
  SpringConstants one{spring.stiffness, spring.damping};
  if (!spring.material.empty()) one.k = pad_of(spring).stiffness();
  if (spring.frequency) {
    const double omega = 2.0 * std::numbers::pi * *spring.frequency;
    one.k = *spring.carries * omega * omega / n;
  }
  if (spring.damping_ratio) one.c = 2.0 * *spring.damping_ratio * std::sqrt(n * one.k * *spring.carries) / n;
  return one;
}

const ElementKind& spring_damper_kind() {
  static const ElementKind kind = [] {
    using T = SpringDamper;
    ElementKind k;
    k.name = "spring_damper";
    k.doc = "Spring and damper between two markers, along an axis fixed in body b or from point to point. "
            "The force on a is f = -k d - c d' along the axis (away from b), d the elongation.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker on the first body");
    f.add("b", &T::b).as(FieldType::marker).doc("marker on the second body");
    f.add("axis", &T::axis).doc("direction in marker b's axes; without it, from point to point");
    f.add("across", &T::across).in("m").not_negative().doc("distance of its ends across the plane; its length is that in space");
    f.add("stiffness", &T::stiffness).in("N/m").not_negative().doc("k of one element");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("c of one element");
    f.add("carries", &T::carries).in("kg").positive().doc("mass on all of them, for frequency and damping_ratio");
    f.add("frequency", &T::frequency).in("Hz").positive().doc("of that mass on them, instead of stiffness: k = m (2 pi f)^2");
    f.add("damping_ratio", &T::damping_ratio).not_negative().doc("of that mass, instead of damping: c = 2 zeta sqrt(k m)");
    add_pad_fields<T>(f);
    f.add("count", &T::count).at_least(1).doc("equal elements side by side");
    f.add("free_length", &T::free_length).in("m").doc("distance at which it gives no force; default: that of the reference pose");
    f.add("preload", &T::preload).in("N").doc("force f of all in the reference pose, instead of free_length");
    f.add("gap", &T::gap).in("m").not_negative().doc("width of a dead band around the free length");
    f.add("force_table", &T::force_table).in("m", "N").doc("[d, -f] pairs instead of stiffness, linear between");
    f.add("damping_table", &T::damping_table).in("m/s", "N").doc("[d', -f] pairs instead of damping");
    f.add("between", &T::between)
        .one_of({"lines", "curve"})
        .doc("how tables go from point to point: straight, each corner an event; or the cubic spline, smooth and without events");
    k.example = R"([[element]]
name = 'spring'
kind = 'spring_damper'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
stiffness = 1e5
damping = 1e3
)";
    k.holds<T>();
    k.compile = compile_spring_damper;
    return k;
  }();
  return kind;
}

const ElementKind& rotational_spring_damper_kind() {
  static const ElementKind kind = [] {
    using T = RotationalSpringDamper;
    ElementKind k;
    k.name = "rotational_spring_damper";
    k.doc = "Spring and damper on the relative angle of two bodies: couple -k d - c d' on a, d the angle of "
            "a against b minus the free angle.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker on the first body");
    f.add("b", &T::b).as(FieldType::marker).doc("marker on the second body");
    f.add("stiffness", &T::stiffness).in("N m/rad").not_negative().doc("k of one element");
    f.add("damping", &T::damping).in("N m s/rad").not_negative().doc("c of one element");
    f.add("count", &T::count).at_least(1).doc("equal elements side by side");
    f.add("free_angle", &T::free_angle).in("rad").doc("of marker a's axes against marker b's; default: that of the reference pose");
    f.add("preload", &T::preload).in("N m").doc("couple on a in the reference pose, instead of free_angle");
    f.add("gap", &T::gap).in("rad").not_negative().doc("width of a dead band around the free angle");
    f.add("couple_table", &T::couple_table).in("rad", "N m").doc("[d, -couple] pairs instead of stiffness");
    f.add("damping_table", &T::damping_table).in("rad/s", "N m").doc("[d', -couple] pairs instead of damping");
    f.add("between", &T::between)
        .one_of({"lines", "curve"})
        .doc("how tables go from point to point: straight, each corner an event; or the cubic spline, smooth and without events");
    k.example = R"([[element]]
name = 'torsion spring'
kind = 'rotational_spring_damper'
a = 'a'
b = 'b'
stiffness = 1e4
damping = 100.0
)";
    k.holds<T>();
    k.compile = compile_rotational;
    return k;
  }();
  return kind;
}

} // namespace steplap
