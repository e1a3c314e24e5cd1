#include "elements/prescribed_motion.h"

#include "mbd/base/number_text.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

DriveLevel level_of(const std::string& as) {
  if (as == "position") return DriveLevel::position;
  return as == "velocity" ? DriveLevel::velocity : DriveLevel::acceleration;
}

// Returns which coordinate of body a the row prescribes directly, 0, 1, 2 for x, y, θ of the centre of gravity in ground axes; −1 if it is
// none. Such a coordinate can be locked, without a constraint row.
int lockable_coordinate(const RowSpec& row, const CompiledMarker& a) {
  if (a.body == k_ground || row.b != k_ground || row.kind == MeasureKind::distance) return -1;
  if (row.kind == MeasureKind::angle) return 2;
  if (a.point != Vec2::Zero()) return -1;
  if (row.direction == Vec2(1.0, 0.0)) return 0;
  return row.direction == Vec2(0.0, 1.0) ? 1 : -1;
}

// Returns the message for a signal that jumps. A jump of velocity is an impact, which a drive cannot perform, because everything connected
// by joints would have to jump, too.
std::string jump_message(const PrescribedMotion& e, const Signal::Jump& jump) {
  const std::string what = jump.is_of_rate ? "the rate of signal '" : "signal '";
  const std::string moved = !jump.is_of_rate && e.as == "position" ? "body" : "body's velocity";
  const std::string remedy = jump.is_of_rate ? "give the motion as = \"velocity\" or as = \"acceleration\" by the signal's "
                                               "derivative, or use a smooth signal such as haversine"
                                             : "use a signal without jumps or as = \"acceleration\"";
  return what + e.signal + "' jumps from " + number_text(jump.before) + " to " + number_text(jump.after) +
         " at t = " + number_text(jump.t) + " s, so it cannot be a " + e.as + ": the " + moved + " would have to jump; " + remedy;
}

// Returns true if the positions differ by more than the rounding of a pose given with few digits.
bool jumps(double now, double wanted) {
  constexpr double k_rough = 1e-3, k_least_jump = 1e-9; // relative to the coordinate; m, rad
  return std::abs(wanted - now) > std::max(k_least_jump, k_rough * std::max(std::abs(now), std::abs(wanted)));
}

std::string start_message(const PrescribedMotion& e, const RowSpec& row, double now, double wanted) {
  if (std::abs(wanted) < 1e-12 * std::abs(now)) wanted = 0.0; // rounding error of a computed zero, such as the sine of π
  const std::string unit = row.kind == MeasureKind::angle ? " rad" : " m";
  std::string text = "the reference pose has " + number_text(now) + unit + " where the motion begins with " + number_text(wanted) + unit +
                     " at t = 0: the body would have to jump. ";
  if (e.zero != "reference")
    return text + "A position counts from the coordinate's own zero: place the body there, or let it count from the reference "
                  "pose with zero = \"reference\"";
  return text + "Use a signal that begins with zero, or place the body there";
}

void compile_prescribed(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const PrescribedMotion&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("drives a body against itself");
  if (e.zero == "reference" && e.as != "position") return builder.error("'zero' belongs to as = \"position\"");
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
  if (const auto jump = row.drive->first_jump(row.level, 0.0, builder.model().simulation.end)) return builder.error(jump_message(e, *jump));
  const double now = evaluate_row<false>(row, &builder.reference(0)).value;
  // The measure of an angle is that of the bodies; a position is of the markers' axes.
  const double zero = row.kind == MeasureKind::angle ? b.angle - a.angle : 0.0;
  const double base = e.zero == "reference" ? now : zero;
  // Necessary even for a position relative to the reference pose, because the start would move the body without notice.
  if (row.level == DriveLevel::position)
    if (const double wanted = base + row.drive->value(0.0); jumps(now, wanted))
      return builder.error(start_message(e, row, now - zero, wanted - zero));
  row.base = builder.add_base(base);
  const int r = builder.next_row();
  builder.add_channel("reaction", row.kind == MeasureKind::angle ? "N m" : "N",
                      {"force or couple on a that the motion takes", "positive: towards larger values of the coordinate"},
                      [r](const Snapshot& s) { return s.row_force[r]; });
  const bool is_angle = row.kind == MeasureKind::angle;
  builder.offer_channel(is_angle ? "angle" : "displacement", is_angle ? "rad" : "m",
                        {"its coordinate, since the reference pose", "as the coordinate counts"},
                        MeasuredValue{[row, now](const Snapshot& s) { return evaluate_row<false>(row, s.motion).value - now; }, row, now});
  builder.offer_channel("rate", is_angle ? "rad/s" : "m/s", {"of its coordinate", "positive: it grows"},
                        MeasuredValue{[row](const Snapshot& s) { return evaluate_row<false>(row, s.motion).rate; }, row, 0.0, true});
  builder.offer_channel("power", "W", {"power that it gives", "negative while it brakes"},
                        [row, r](const Snapshot& s) { return s.row_force[r] * evaluate_row<false>(row, s.motion).rate; });
  builder.add_rows({row}, false, lockable_coordinate(row, a));
}

} // namespace

const ElementKind& prescribed_motion_kind() {
  static const ElementKind kind = [] {
    using T = PrescribedMotion;
    ElementKind k;
    k.name = "prescribed_motion";
    k.doc = "A coordinate of a against b follows a signal exactly; the reaction is the force required.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is driven");
    f.add("b", &T::b).as(FieldType::marker).doc("marker whose axes count");
    f.add("coordinate", &T::coordinate)
        .one_of({"x", "y", "angle", "distance"})
        .doc("x, y: of marker a in marker b's axes; angle of a's axes against b's; distance of the markers");
    f.add("signal", &T::signal)
        .as(FieldType::signal)
        .in("rad|m")
        .required()
        .doc("signal that it follows (a velocity's per s, an acceleration's per s^2)");
    f.add("as", &T::as)
        .one_of({"acceleration", "velocity", "position"})
        .doc("what the signal is; acceleration and velocity start from the initial pose, a position is absolute (see zero)");
    f.add("zero", &T::zero)
        .one_of({"origin", "reference"})
        .doc("as = \"position\": the signal is the coordinate itself, or counts from its value in the reference pose");
    k.example = R"([[signal]]
name = 'stroke'
kind = 'half_sine'
peak = 0.1
duration = 1.0
[[element]]
name = 'shaker'
kind = 'prescribed_motion'
a = 'a'
coordinate = 'x'
as = 'velocity'
signal = 'stroke'
)";
    k.holds<T>();
    k.compile = compile_prescribed;
    k.acts_from_outside = [](const Element&, const Model&) { return true; };
    return k;
  }();
  return kind;
}

} // namespace steplap
