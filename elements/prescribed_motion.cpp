#include "elements/prescribed_motion.h"

#include "mbd/system.h"

namespace steplap {

namespace {

DriveLevel level_of(const std::string& as) {
  if (as == "position") return DriveLevel::position;
  return as == "velocity" ? DriveLevel::velocity : DriveLevel::acceleration;
}

// A coordinate of a body's own centre of gravity against the ground's axes can be locked instead of
// held by a row: 0, 1, 2 for x, y, θ, else −1.
int lockable_coordinate(const RowSpec& row, const CompiledMarker& a) {
  if (a.body == k_ground || row.b != k_ground || row.kind == MeasureKind::distance) return -1;
  if (row.kind == MeasureKind::angle) return 2;
  if (a.point != Vec2::Zero() || row.point_b != Vec2::Zero()) return -1;
  if (row.direction == Vec2(1.0, 0.0)) return 0;
  return row.direction == Vec2(0.0, 1.0) ? 1 : -1;
}

bool is_differentiable_enough(const Signal& signal, DriveLevel level) {
  if (level == DriveLevel::acceleration) return true;
  for (std::size_t k = 0; k < signal.breakpoints().size(); ++k)
    if (signal.breakpoints()[k] > 0.0 && signal.jumps_at(k)) return false;
  return true;
}

void compile_prescribed(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const PrescribedMotion&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("drives a body against itself");
  RowSpec row;
  row.a = a.body;
  row.b = b.body;
  row.point_a = a.point;
  row.point_b = b.point;
  row.quantity = "drive";
  if (e.coordinate == "angle") row.kind = MeasureKind::angle;
  else if (e.coordinate == "distance") row.kind = MeasureKind::distance;
  else row.direction = builder.direction(b, e.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0));
  row.drive = builder.signal(e.signal);
  row.level = level_of(e.as);
  if (!is_differentiable_enough(*row.drive, row.level))
    return builder.error("signal '" + e.signal + "' jumps, so it cannot be a " + e.as +
                         ": the body would have to jump; use a signal without jumps or as = \"acceleration\"");
  row.memory = builder.add_memory();
  const int r = builder.next_row();
  builder.add_channel("reaction", row.kind == MeasureKind::angle ? "N m" : "N",
                      "force or couple on a that the motion takes",
                      [r](const Snapshot& s) { return s.row_force[r]; });
  builder.add_rows({row}, false, lockable_coordinate(row, a));
}

} // namespace

const ElementKind& prescribed_motion_kind() {
  static const ElementKind kind = [] {
    using T = PrescribedMotion;
    ElementKind k;
    k.name = "prescribed_motion";
    k.doc = "A coordinate of a against b follows a signal exactly; the reaction is what it takes.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is driven");
    f.add("b", &T::b).as(FieldType::marker).doc("marker whose axes count");
    f.add("coordinate", &T::coordinate).one_of({"x", "y", "angle", "distance"}).doc(
        "x, y: of marker a in marker b's axes; angle of a against b; distance of the markers");
    f.add("signal", &T::signal).as(FieldType::signal).required().doc("signal that it follows");
    f.add("as", &T::as).one_of({"acceleration", "velocity", "position"}).doc(
        "what the signal is; acceleration and velocity start from the initial pose");
    k.create = [] { return std::shared_ptr<Element>(std::make_shared<T>()); };
    k.compile = compile_prescribed;
    return k;
  }();
  return kind;
}

} // namespace steplap
