#include "elements/joints.h"

#include "mbd/system.h"

namespace steplap {

namespace {

struct Ends {
  CompiledMarker a, b;
};

Ends ends_of(const Joint& e, const SystemBuilder& builder) {
  return {builder.marker(e.a), builder.marker(e.b)};
}

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

// Held at its value in the reference pose.
void hold_as_given(RowSpec& row, SystemBuilder& builder) {
  row.memory = builder.add_memory(evaluate_row<false>(row, &builder.reference(0)).value);
}

bool joins_two_bodies(const Ends& ends, SystemBuilder& builder) {
  if (ends.a.body != ends.b.body) return true;
  builder.error("joins a body to itself: name markers on two different bodies");
  return false;
}

void add(SystemBuilder& builder, std::vector<RowSpec> rows, bool is_rigid = false) {
  const int first = builder.next_row();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int r = first + static_cast<int>(i);
    const bool is_angle = rows[i].kind == MeasureKind::angle;
    builder.add_channel(rows[i].quantity, is_angle ? "N m" : "N", "reaction on a along the direction held",
                        [r](const Snapshot& s) { return s.row_force[r]; });
  }
  builder.add_rows(std::move(rows), is_rigid);
}

void compile_revolute(const Element& element, SystemBuilder& builder) {
  const Ends ends = ends_of(static_cast<const Joint&>(element), builder);
  if (!joins_two_bodies(ends, builder)) return;
  add(builder, {row_between(ends, MeasureKind::axis, builder.direction(ends.b, {1.0, 0.0}), "force_x"),
                row_between(ends, MeasureKind::axis, builder.direction(ends.b, {0.0, 1.0}), "force_y")});
}

void compile_weld(const Element& element, SystemBuilder& builder) {
  const Ends ends = ends_of(static_cast<const Joint&>(element), builder);
  if (!joins_two_bodies(ends, builder)) return;
  std::vector<RowSpec> rows = {
      row_between(ends, MeasureKind::axis, builder.direction(ends.b, {1.0, 0.0}), "force_x"),
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
  std::vector<RowSpec> rows = {
      row_between(ends, MeasureKind::axis, builder.direction(ends.b, perp(e.axis)), "force"),
      row_between(ends, MeasureKind::angle, Vec2::Zero(), "couple")};
  for (RowSpec& row : rows) hold_as_given(row, builder);
  add(builder, rows);
}

void compile_point_on_line(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Joint&>(element);
  const Ends ends = ends_of(e, builder);
  if (!joins_two_bodies(ends, builder)) return;
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  add(builder, {row_between(ends, MeasureKind::axis, builder.direction(ends.b, perp(e.axis)), "force")});
}

void compile_distance(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Joint&>(element);
  const Ends ends = ends_of(e, builder);
  if (!joins_two_bodies(ends, builder)) return;
  RowSpec row = row_between(ends, MeasureKind::distance, Vec2::Zero(), "force");
  const double now = (builder.marker_position(ends.a) - builder.marker_position(ends.b)).norm();
  if (now < 1e-12)
    return builder.error("its ends coincide, so its direction is undefined: use a revolute joint");
  row.memory = builder.add_memory(e.length.value_or(now));
  add(builder, {row});
}

ElementKind joint_kind(const char* name, const char* doc, bool has_axis, bool has_length,
                       void (*compile)(const Element&, SystemBuilder&)) {
  ElementKind k;
  k.name = name;
  k.doc = doc;
  FieldTable& f = k.fields;
  f.add("a", &Joint::a).as(FieldType::marker).required().doc("marker on the first body");
  f.add("b", &Joint::b).as(FieldType::marker).doc("marker on the second body, whose axes count");
  if (has_axis) f.add("axis", &Joint::axis).doc("direction left free, in marker b's axes");
  if (has_length)
    f.add("length", &Joint::length).in("m").positive().doc("default: the distance in the reference pose");
  k.create = [] { return std::shared_ptr<Element>(std::make_shared<Joint>()); };
  k.compile = compile;
  return k;
}

} // namespace

const ElementKind& revolute_kind() {
  static const ElementKind kind =
      joint_kind("revolute", "A pin: the two markers stay together, the bodies turn freely.", false, false,
                 compile_revolute);
  return kind;
}
const ElementKind& prismatic_kind() {
  static const ElementKind kind = joint_kind(
      "prismatic", "A slide: a moves along an axis of b and does not turn against it.", true, false,
      compile_prismatic);
  return kind;
}
const ElementKind& weld_kind() {
  static const ElementKind kind =
      joint_kind("weld", "Holds a and b together as in the reference pose; the two are integrated as one body.",
                 false, false, compile_weld);
  return kind;
}
const ElementKind& distance_kind() {
  static const ElementKind kind = joint_kind(
      "distance", "A massless rod: the markers keep their distance.", false, true, compile_distance);
  return kind;
}
const ElementKind& point_on_line_kind() {
  static const ElementKind kind =
      joint_kind("point_on_line", "Marker a stays on a line of b and may turn and slide on it.", true, false,
                 compile_point_on_line);
  return kind;
}

} // namespace steplap
