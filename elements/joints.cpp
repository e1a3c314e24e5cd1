#include "elements/joints.h"

#include "mbd/formula/formula.h"
#include "mbd/system/formula_channel.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>

namespace steplap {

namespace {

struct Ends {
  CompiledMarker a, b;
};

Ends ends_of(const Joint& e, const SystemBuilder& builder) { return {builder.marker(e.a), builder.marker(e.b)}; }

RowSpec row_between(const Ends& ends, MeasureKind kind, const Vec2& direction, const char* quantity) {
  RowSpec row;
  row.kind = kind;
  row.a = ends.a.body;
  row.b = ends.b.body;
  row.point_a = ends.a.point;
  row.point_b = ends.b.point;
  row.direction = direction;
  row.quantity = quantity;
  return row;
}

// Constrains the row to its value in the reference pose.
void hold_as_given(RowSpec& row, SystemBuilder& builder) {
  row.base = builder.add_base(evaluate_row<false>(row, &builder.reference(0)).value);
}

bool joins_two_bodies(const Ends& ends, SystemBuilder& builder) {
  if (ends.a.body != ends.b.body) return true;
  builder.error("joins a body to itself: name markers on two different bodies");
  return false;
}

std::string_view sign_of(const RowSpec& row) {
  const std::string_view quantity = row.quantity;
  if (row.kind == MeasureKind::angle) return "positive counter-clockwise";
  if (row.kind == MeasureKind::distance) return "positive: it pushes a away from b";
  if (quantity == "force_x") return "along x of marker b's axes";
  return quantity == "force_y" ? "along y of marker b's axes" : "along the free axis turned counter-clockwise by a right angle";
}

// Size of the force of rows `first` and `first` + 1 as a formula of both: its minimum is a kink where one of them passes zero, which samples
// do not show. The formula is made when the channel is.
struct ReactionSize {
  const std::string& element;
  int first;

  operator std::function<double(const Snapshot&)>() const { // NOLINT: implicit
    static const Formula size("hypot(x, y)", "", {});
    static const std::string newton = "N", none;
    const auto component = [&](const char* name, int row) {
      return Channel{element + name, newton, none, none, none, [row](const Snapshot& s) { return s.row_force[row]; }};
    };
    const Channel x = component(".force_x", first), y = component(".force_y", first + 1);
    return FormulaValue{std::make_shared<const FormulaChannel>(size.tree(), std::vector<const Channel*>{&x, &y}, 1.0)};
  }
};

void add(SystemBuilder& builder, std::vector<RowSpec> rows, bool is_rigid = false) {
  const int first = builder.next_row();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int r = first + static_cast<int>(i);
    builder.add_channel(rows[i].quantity, rows[i].kind == MeasureKind::angle ? "N m" : "N", {"reaction on a", sign_of(rows[i])},
                        [r](const Snapshot& s) { return s.row_force[r]; });
  }
  std::array<RowSpec, 3> held; // no joint constrains more than three rows
  std::copy(rows.begin(), rows.end(), held.begin());
  if (rows.size() > 1 && rows[1].kind == MeasureKind::axis)
    builder.offer_channel("reaction", "N", {"size of the reaction force", "never negative"},
                          ReactionSize{builder.compiled().element_names[builder.element_index()], first});
  builder.offer_channel("power", "W", "power of the reactions: zero up to numerical error",
                        [held, count = static_cast<int>(rows.size()), first](const Snapshot& s) {
                          double power = 0.0;
                          for (int i = 0; i < count; ++i) power += s.row_force[first + i] * evaluate_row<false>(held[i], s.motion).rate;
                          return power;
                        });
  builder.add_rows(std::move(rows), is_rigid);
}

void offer_angle(const Ends& ends, SystemBuilder& builder) {
  const RowSpec row = row_of(ends.a.body, ends.b.body, AngleMeasure{});
  builder.offer_channel("angle", "rad", {"of marker a's axes against marker b's", "positive: a turned counter-clockwise"},
                        MeasuredValue{[a = ends.a, b = ends.b](const Snapshot& s) {
                                        return relative_angle(s.motion[a.body], s.motion[b.body]) + (a.angle - b.angle);
                                      },
                                      row, ends.b.angle - ends.a.angle});
  builder.offer_channel(
      "rate", "rad/s", {"of the angle", "positive: a turns counter-clockwise"},
      MeasuredValue{[a = ends.a.body, b = ends.b.body](const Snapshot& s) { return relative_spin(s.motion[a], s.motion[b]); }, row, 0.0,
                    true});
}

void offer_displacement(const Ends& ends, const Vec2& axis, SystemBuilder& builder) {
  const AxisMeasure along{ends.a.point, ends.b.point, builder.direction(ends.b, axis)};
  const auto measured = [along, a = ends.a.body, b = ends.b.body](const Snapshot& s) { return along.at<false>(s.motion[a], s.motion[b]); };
  const RowSpec row = row_of(ends.a.body, ends.b.body, along);
  builder.offer_channel("displacement", "m", {"of marker a from marker b", "along the free axis"},
                        MeasuredValue{[measured](const Snapshot& s) { return measured(s).value; }, row});
  builder.offer_channel("rate", "m/s", {"of the displacement", "along the free axis"},
                        MeasuredValue{[measured](const Snapshot& s) { return measured(s).rate; }, row, 0.0, true});
}

void compile_revolute(const Element& element, SystemBuilder& builder) {
  const Ends ends = ends_of(static_cast<const Joint&>(element), builder);
  if (!joins_two_bodies(ends, builder)) return;
  add(builder, {row_between(ends, MeasureKind::axis, builder.direction(ends.b, {1.0, 0.0}), "force_x"),
                row_between(ends, MeasureKind::axis, builder.direction(ends.b, {0.0, 1.0}), "force_y")});
  offer_angle(ends, builder);
}

void compile_weld(const Element& element, SystemBuilder& builder) {
  const Ends ends = ends_of(static_cast<const Joint&>(element), builder);
  if (!joins_two_bodies(ends, builder)) return;
  std::vector<RowSpec> rows = {row_between(ends, MeasureKind::axis, builder.direction(ends.b, {1.0, 0.0}), "force_x"),
                               row_between(ends, MeasureKind::axis, builder.direction(ends.b, {0.0, 1.0}), "force_y"),
                               row_between(ends, MeasureKind::angle, Vec2::Zero(), "couple")};
  for (RowSpec& row : rows) hold_as_given(row, builder);
  add(builder, rows, true);
}

void compile_prismatic(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Joint&>(element);
  const Ends ends = ends_of(e, builder);
  if (!joins_two_bodies(ends, builder)) return;
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  std::vector<RowSpec> rows = {row_between(ends, MeasureKind::axis, builder.direction(ends.b, perp(e.axis)), "force"),
                               row_between(ends, MeasureKind::angle, Vec2::Zero(), "couple")};
  for (RowSpec& row : rows) hold_as_given(row, builder);
  add(builder, rows);
  offer_displacement(ends, e.axis, builder);
}

void compile_point_on_line(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Joint&>(element);
  const Ends ends = ends_of(e, builder);
  if (!joins_two_bodies(ends, builder)) return;
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  add(builder, {row_between(ends, MeasureKind::axis, builder.direction(ends.b, perp(e.axis)), "force")});
  offer_displacement(ends, e.axis, builder);
}

void compile_distance(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Joint&>(element);
  const Ends ends = ends_of(e, builder);
  if (!joins_two_bodies(ends, builder)) return;
  RowSpec row = row_between(ends, MeasureKind::distance, Vec2::Zero(), "force");
  const double now = (builder.marker_position(ends.a) - builder.marker_position(ends.b)).norm();
  if (now < 1e-12) return builder.error("its ends coincide, so its direction is undefined: use a revolute joint");
  row.base = builder.add_base(e.length.value_or(now));
  add(builder, {row});
}

template <class Made = Joint> ElementKind joint_kind(const char* name, const char* doc, void (*compile)(const Element&, SystemBuilder&)) {
  ElementKind k;
  k.name = name;
  k.doc = doc;
  k.fields.add("a", &Joint::a).as(FieldType::marker).required().doc("marker on the first body");
  k.fields.add("b", &Joint::b).as(FieldType::marker).doc("marker on the second body, whose axes count");
  k.holds<Made>();
  k.compile = compile;
  return k;
}

struct Slide : Joint {
  Slide() { is_slide = true; }
};

void add_axis(FieldTable& f) { f.add("axis", &Joint::axis).doc("direction left free, in marker b's axes"); }

} // namespace

std::optional<RelativePose> Joint::relative_pose() const {
  if (is_slide ? !displacement : !angle) return std::nullopt;
  RelativePose pose;
  pose.angle = angle.value_or(0.0);
  pose.spin = angular_velocity.value_or(0.0);
  if (!is_slide || axis.norm() == 0.0) return pose;
  pose.shift = *displacement * axis.normalized();
  pose.velocity = speed.value_or(0.0) * axis.normalized();
  return pose;
}

const char* Joint::idle_field() const {
  if (is_slide) return angle ? "angle" : speed ? "speed" : nullptr;
  return angular_velocity ? "angular_velocity" : nullptr;
}

const ElementKind& revolute_kind() {
  static const ElementKind kind = [] {
    ElementKind k = joint_kind("revolute", "A pin: the two markers stay together, the bodies turn freely.", compile_revolute);
    k.fields.add("angle", &Joint::angle)
        .in("rad")
        .doc("of marker a's axes against marker b's in the reference pose: places the body without a given pose");
    k.fields.add("angular_velocity", &Joint::angular_velocity).in("rad/s").doc("with 'angle': its rate at the start; 0 if not given");
    k.example = R"([[element]]
name = 'pin'
kind = 'revolute'
a = { body = 'a', at = [0.0, 0.0] }
b = { body = 'b', at = [0.0, 0.0] }
)";
    return k;
  }();
  return kind;
}
const ElementKind& prismatic_kind() {
  static const ElementKind kind = [] {
    ElementKind k = joint_kind<Slide>("prismatic", "A slide: a moves along an axis of b and does not turn against it.", compile_prismatic);
    add_axis(k.fields);
    k.fields.add("displacement", &Joint::displacement)
        .in("m")
        .doc("of marker a from marker b along the axis in the reference pose: places the body without a given pose");
    k.fields.add("angle", &Joint::angle).in("rad").doc("with 'displacement': of marker a's axes against marker b's; 0 if not given");
    k.fields.add("speed", &Joint::speed).in("m/s").doc("with 'displacement': its rate at the start; 0 if not given");
    k.example = R"([[element]]
name = 'guide'
kind = 'prismatic'
a = { body = 'a', at = [0.0, 0.0] }
b = { body = 'b', at = [0.0, 0.0] }
axis = [0.0, 1.0]
)";
    return k;
  }();
  return kind;
}
const ElementKind& weld_kind() {
  static const ElementKind kind = [] {
    ElementKind k =
        joint_kind("weld", "Holds a and b together as in the reference pose; the two are integrated as one body.", compile_weld);
    k.fields.add("angle", &Joint::angle)
        .in("rad")
        .doc("of marker a's axes against marker b's: places the body without a given pose, marker on marker");
    k.example = R"([[element]]
name = 'weld'
kind = 'weld'
a = { body = 'a', at = [0.0, 0.0] }
b = { body = 'b', at = [0.0, 0.0] }
)";
    return k;
  }();
  return kind;
}
const ElementKind& distance_kind() {
  static const ElementKind kind = [] {
    ElementKind k = joint_kind("distance", "A massless rod: the markers keep their distance.", compile_distance);
    k.fields.add("length", &Joint::length).in("m").positive().doc("default: the distance in the reference pose");
    k.example = R"([[element]]
name = 'rod'
kind = 'distance'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
)";
    return k;
  }();
  return kind;
}
const ElementKind& point_on_line_kind() {
  static const ElementKind kind = [] {
    ElementKind k = joint_kind("point_on_line", "Marker a stays on a line of b and may turn and slide on it.", compile_point_on_line);
    add_axis(k.fields);
    k.example = R"([[element]]
name = 'slot'
kind = 'point_on_line'
a = { body = 'a', at = [0.0, 0.0] }
b = { body = 'b', at = [0.0, 0.0] }
axis = [1.0, 0.0]
)";
    return k;
  }();
  return kind;
}

} // namespace steplap
