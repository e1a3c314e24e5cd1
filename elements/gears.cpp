#include "elements/gears.h"

#include "mbd/base/shown_text.h"
#include "mbd/system/system.h"

#include <cmath>

namespace steplap {

namespace {

// Relative tolerance for pitch circles that should touch, whose data have few digits in a file.
constexpr double k_pitch_tolerance = 1e-6;

void add_row(RowSpec row, SystemBuilder& builder) {
  row.quantity = "force";
  row.base = builder.add_base(evaluate_row<false>(row, &builder.reference(0)).value);
  const int r = builder.next_row();
  builder.add_channel("force", "N",
                      {"force between the teeth, on a", "along the common tangent, as a's rim moves when it turns counter-clockwise"},
                      [r, sign = row.radius_a < 0.0 ? -1.0 : 1.0](const Snapshot& s) { return sign * s.row_force[r]; });
  builder.offer_channel("power", "W", "power of the constraint: zero up to numerical error",
                        [row, r](const Snapshot& s) { return s.row_force[r] * evaluate_row<false>(row, s.motion).rate; });
  builder.add_rows({row});
}

RowSpec row_between(const CompiledMarker& a, const CompiledMarker& b) {
  RowSpec row;
  row.a = a.body;
  row.b = b.body;
  row.point_a = a.point;
  row.point_b = b.point;
  return row;
}

void compile_gear(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Gear&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body to itself: name markers on two different bodies");
  if (e.inside && e.radius_b <= e.radius_a)
    return builder.error("with inside = true 'radius_b', the ring's, must be greater than 'radius_a'");
  const Vec2 apart = builder.marker_position(a) - builder.marker_position(b);
  const double reach = e.inside ? e.radius_b - e.radius_a : e.radius_a + e.radius_b;
  if (std::abs(apart.norm() - reach) > k_pitch_tolerance * reach)
    return builder.error("its centres are " + rounded_text(apart.norm()) + " m apart, but the pitch circles touch at " +
                         rounded_text(reach) + " m");
  RowSpec row = row_between(a, b);
  row.kind = MeasureKind::roll_round;
  row.radius_a = e.inside ? -e.radius_a : e.radius_a;
  row.radius_b = e.radius_b;
  row.direction = rotated(apart.normalized(), -builder.reference(b.body).theta);
  add_row(row, builder);
}

void compile_rack(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Rack&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body to itself: name markers on two different bodies");
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  RowSpec row = row_between(a, b);
  row.kind = MeasureKind::roll_line;
  row.direction = builder.direction(b, perp(e.axis));
  const Vec2 left = rotated(row.direction, builder.reference(b.body).theta);
  if (left.dot(builder.marker_position(a) - builder.marker_position(b)) < -k_pitch_tolerance * e.radius)
    return builder.error("its pinion is on the right of 'axis' and would turn the wrong way: turn 'axis' round");
  row.radius_a = e.radius;
  add_row(row, builder);
}

} // namespace

const ElementKind& gear_kind() {
  static const ElementKind kind = [] {
    using T = Gear;
    ElementKind k;
    k.name = "gear";
    k.doc = "Two gears: their pitch circles roll on each other, whether or not their carrier turns. Bearings keep "
            "the centres apart.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the first gear");
    f.add("b", &T::b).as(FieldType::marker).required().doc("centre of the second gear");
    f.add("radius_a", &T::radius_a).in("m").positive().required().doc("pitch radius of the first gear");
    f.add("radius_b", &T::radius_b).in("m").positive().required().doc("pitch radius of the second gear");
    f.add("inside", &T::inside).doc("true: the second is a ring with the first inside");
    k.example = R"([[element]]
name = 'gears'
kind = 'gear'
a = 'a'
b = 'b'
radius_a = 0.8
radius_b = 1.2
)";
    k.holds<T>();
    k.compile = compile_gear;
    return k;
  }();
  return kind;
}

const ElementKind& rack_kind() {
  static const ElementKind kind = [] {
    using T = Rack;
    ElementKind k;
    k.name = "rack";
    k.doc = "A pinion of a rolls on a rack of b, on the left of its axis. Something else keeps it there.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the pinion");
    f.add("b", &T::b).as(FieldType::marker).doc("marker on the rack");
    f.add("radius", &T::radius).in("m").positive().required().doc("pitch radius of the pinion");
    f.add("axis", &T::axis).doc("direction of the rack, in marker b's axes");
    k.example = R"([[element]]
name = 'rack'
kind = 'rack'
a = 'a'
b = { body = 'b', at = [0.0, 0.5] }
radius = 0.5
)";
    k.holds<T>();
    k.compile = compile_rack;
    return k;
  }();
  return kind;
}

} // namespace steplap
