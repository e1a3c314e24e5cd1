#include "elements/limit.h"

#include "elements/contact_laws.h"
#include "elements/restitution.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Modes: 0 between the stops; 1 and 2 lower stop pressed and released; 3 and 4 upper stop.
constexpr UnitMode k_between = 0, k_lower = 1, k_upper = 3;

struct StopsLaw {
  static constexpr int k_event_count = 2;
  static constexpr bool k_is_contact = false;
  KelvinVoigtContact lower, upper; ///< the upper stop acts on the coordinate with reversed sign

  static bool is_upper(UnitMode mode) { return mode >= k_upper; }
  static UnitMode contact_mode(UnitMode mode) {
    if (mode == k_between) return k_contact_open;
    return mode == k_lower || mode == k_upper ? k_contact_pressed : k_contact_released;
  }
  static UnitMode stop_mode(UnitMode contact, bool is_up) {
    if (contact == k_contact_open) return k_between;
    const int pressed = is_up ? k_upper : k_lower;
    return static_cast<UnitMode>(contact == k_contact_pressed ? pressed : pressed + 1);
  }

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    return is_upper(mode) ? -upper.force(-value, -rate, contact_mode(mode)) : lower.force(value, rate, contact_mode(mode));
  }
  [[nodiscard]] double elastic_force(double value, UnitMode mode) const {
    return is_upper(mode) ? -upper.elastic_force(-value, contact_mode(mode)) : lower.elastic_force(value, contact_mode(mode));
  }
  [[nodiscard]] double energy(double value) const { return lower.energy(value) + upper.energy(-value); }
  [[nodiscard]] UnitMode initial_mode(double value, double rate) const {
    if (const UnitMode mode = lower.initial_mode(value, rate); mode != k_contact_open) return stop_mode(mode, false);
    return stop_mode(upper.initial_mode(-value, -rate), true);
  }
  void event_value(double value, double rate, UnitMode mode, double* event_value, double* event_derivative) const {
    if (mode != k_between) {
      event_derivative[1] = std::numeric_limits<double>::quiet_NaN(); // unknown: the second event function is a force or unused
      if (is_upper(mode)) upper.event_value(-value, -rate, contact_mode(mode), event_value, event_derivative);
      else lower.event_value(value, rate, contact_mode(mode), event_value, event_derivative);
      return;
    }
    event_value[0] = value - lower.offset;
    event_derivative[0] = rate;
    event_value[1] = -value - upper.offset;
    event_derivative[1] = -rate;
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double value, double rate, double rounding) const {
    const bool is_up = mode == k_between ? slot == 1 : is_upper(mode);
    const KelvinVoigtContact& stop = is_up ? upper : lower;
    const double v = is_up ? -value : value, r = is_up ? -rate : rate;
    return stop_mode(stop.next_mode(contact_mode(mode), mode == k_between ? 0 : slot, v, r, rounding), is_up);
  }
  [[nodiscard]] bool is_armed_at_entry(UnitMode mode, int slot, double value, double rounding) const {
    const bool is_up = is_upper(mode);
    return mode != k_between && (is_up ? upper : lower).is_armed_at_entry(contact_mode(mode), slot, is_up ? -value : value, rounding);
  }
  static EventKind event_kind(UnitMode from, UnitMode to) {
    if (to == k_between) return EventKind::leaves_stop;
    if (from == k_between || is_upper(from) != is_upper(to))
      return is_upper(to) ? EventKind::reaches_upper_stop : EventKind::reaches_lower_stop;
    return KelvinVoigtContact::event_kind(contact_mode(from), contact_mode(to));
  }
};

// `zero`: value of the measure at which the limited coordinate is zero.
template <class Measure>
LawGroup<Measure, StopsLaw>& add(SystemBuilder& builder, int a, int b, const Measure& measure, double zero, const StopsLaw& law,
                                 bool is_angle) {
  using Group = LawGroup<Measure, StopsLaw>;
  Group& group = builder.group<Group>();
  group.entries.push_back({a, b, measure, law});
  builder.add_unit(group, StopsLaw::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("value", is_angle ? "rad" : "m",
                      {"of the coordinate that is limited, from where its stops count", "as the coordinate counts"},
                      MeasuredValue{[&group, i, zero](const Snapshot& s) { return group.measured(i, *s.evaluation).value - zero; },
                                    row_of(a, b, measure), zero});
  builder.add_channel(is_angle ? "couple" : "force", is_angle ? "N m" : "N",
                      {"what the stop acts with on a along the coordinate, zero between the stops", "positive: towards larger values"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
  return group;
}

// Distance, rad or m, by which a stop is moved inwards if the coordinate starts at it; k_touch_of_size is relative to large coordinates.
// The distance exceeds the errors of assembly and rounding, so that the stop is in contact from the start, with a force of k_touch times
// the stiffness.
constexpr double k_touch = 4e-12, k_touch_of_size = 1e-14;
// Largest distance from a stop, rad or m, that counts as starting at the stop: values computed for the model file are rounded.
constexpr double k_at_stop = 1e-11;

double stop_at(double given, double now, double inwards) {
  const double size = std::max(1.0, std::abs(now));
  return std::abs(given - now) <= k_at_stop * size ? now + inwards * std::max(k_touch, k_touch_of_size * size) : given;
}

template <class Measure>
void add_stops(const Limit& e, SystemBuilder& builder, int a, int b, const Measure& measure, bool is_absolute, bool is_angle) {
  const double now = measure.template at<false, double>(builder.reference(a), builder.reference(b)).value;
  const double zero = is_absolute ? 0.0 : now;
  const double never = std::numeric_limits<double>::max(); // position of a stop that is not given
  StopsLaw law;
  law.lower = {e.stiffness, e.damping, e.lower ? stop_at(zero + *e.lower, now, 1.0) : -never};
  law.upper = {e.stiffness, e.damping, e.upper ? -stop_at(zero + *e.upper, now, -1.0) : -never};
  auto& group = add(builder, a, b, measure, zero, law, is_angle);
  const auto put = [](StopsLaw& stops, double c) { stops.lower.c = stops.upper.c = c; };
  set_damping_from_restitution(group, {e.damping, e.stiffness, e.restitution}, a, b, measure, builder, put);
}

void compile_limit(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Limit&>(element);
  if (!e.lower && !e.upper) return builder.error("stops nothing: give 'lower', 'upper' or both");
  if (e.lower && e.upper && !(*e.lower < *e.upper)) return builder.error("'lower' must be less than 'upper'");
  if (e.restitution && e.damping != 0.0) return builder.error("give 'damping' or 'restitution', not both");
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("stops a body against itself: name markers on two different bodies");
  if (e.coordinate == "angle") return add_stops(e, builder, a.body, b.body, AngleMeasure{}, false, true);
  if (e.coordinate == "distance") {
    if ((builder.marker_position(a) - builder.marker_position(b)).norm() < 1e-12)
      return builder.error("its ends coincide, so its direction is undefined: move a marker");
    return add_stops(e, builder, a.body, b.body, DistanceMeasure{a.point, b.point}, true, false);
  }
  const Vec2 axis = builder.direction(b, e.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0));
  add_stops(e, builder, a.body, b.body, AxisMeasure{a.point, b.point, axis}, false, false);
}

} // namespace

const ElementKind& limit_kind() {
  static const ElementKind kind = [] {
    using T = Limit;
    ElementKind k;
    k.name = "limit";
    k.doc = "Stops at one or both ends of a coordinate of a against b, as spring and damper that press and never hold.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is stopped");
    f.add("b", &T::b).as(FieldType::marker).doc("marker whose axes count");
    f.add("coordinate", &T::coordinate)
        .one_of({"angle", "x", "y", "distance"})
        .doc("angle of a against b; x, y: of marker a in marker b's axes; distance of the markers");
    f.add("lower", &T::lower).in("rad|m").doc("lower stop, from the reference pose (distance: the distance itself)");
    f.add("upper", &T::upper).in("rad|m").doc("upper stop");
    f.add("stiffness", &T::stiffness).in("N m/rad|N/m").positive().required().doc("of a stop");
    f.add("damping", &T::damping).in("N m s/rad|N s/m").not_negative().doc("of a stop");
    f.add("restitution", &T::restitution)
        .positive()
        .at_most(1.0)
        .doc("instead of damping: rate after a blow over that before it, of its bodies with the joints that hold them, in the reference "
             "pose");
    k.example = R"([[element]]
name = 'stops'
kind = 'limit'
a = 'a'
b = 'b'
coordinate = 'y'
lower = -0.1
upper = 0.1
stiffness = 1e6
)";
    k.holds<T>();
    k.compile = compile_limit;
    return k;
  }();
  return kind;
}

} // namespace steplap
