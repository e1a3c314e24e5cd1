#include "mbd/model/model.h"

#include "mbd/model/method.h"

namespace steplap {

Vec3 Body::reference_pose() const {
  const Vec2 centre = position + rotated(cg, angle);
  return {centre.x(), centre.y(), angle};
}

const FieldTable& Body::fields() {
  static const FieldTable table = [] {
    FieldTable f;
    f.add("name", &Body::name).required().doc("unique name; 'ground' is taken");
    f.add("label", &Body::label).doc("what reports call it");
    f.add("mass", &Body::mass).in("kg").positive().required().doc("mass");
    f.add("inertia", &Body::inertia).in("kg m^2").positive().required().doc("moment of inertia about the centre of gravity");
    f.add("position", &Body::position).in("m").doc("origin of the body's frame in the reference pose");
    f.add("angle", &Body::angle).in("rad").doc("angle of the body's frame, counter-clockwise");
    f.add("cg", &Body::cg).in("m").doc("centre of gravity in the body's frame");
    f.add("velocity", &Body::velocity).in("m/s").doc("initial velocity of the centre of gravity");
    f.add("angular_velocity", &Body::angular_velocity).in("rad/s").doc("initial angular velocity");
    f.add("fixed", &Body::fixed).doc("true: does not move");
    f.add("outline", &Body::outline).in("m").doc("corners in the body's frame, for drawings");
    return f;
  }();
  return table;
}

const FieldTable& Marker::fields() {
  static const FieldTable table = [] {
    FieldTable f;
    f.add("name", &Marker::name).required().doc("unique name");
    f.add("body", &Marker::body).as(FieldType::body).required().doc("body that carries it, or 'ground'");
    f.add("point", &Marker::point).in("m").doc("place in the body's frame");
    f.add("at", &Marker::at).in("m").doc("place in the ground frame, bodies in the reference pose");
    f.add("angle", &Marker::angle).in("rad").doc("angle of the marker's axes against the body's");
    return f;
  }();
  return table;
}

const FieldTable& SimulationSettings::fields() {
  static const FieldTable table = [] {
    using T = SimulationSettings;
    FieldTable f;
    f.add("end", &T::end).in("s").positive().doc("end of the run; it starts at t = 0");
    f.add("integrator", &T::integrator).one_of(method_names()).doc("integration method");
    f.add("step", &T::step).in("s").positive().doc("step size of the fixed-step methods, rk4 and moreau");
    f.add("tolerance", &T::tolerance)
        .at_least(1e-14)
        .at_most(0.1)
        .doc("relative tolerance of the adaptive methods, for each step; 1e-8 if not given");
    f.add("coordinates", &T::coordinates)
        .one_of({"automatic", "joint", "absolute"})
        .doc("what describes small mechanisms with pins, and with \"joint\" those that hang on a free body, too: the angles that these "
             "leave, or each body's place and angle; the motion is the same");
    f.add("initial", &T::initial).one_of({"as_given", "equilibrium"}).doc("start from the poses in the file or from static equilibrium");
    f.add("velocity", &T::velocity).in("m/s").doc("added to the initial velocity of every body");
    f.add("projection_tolerance", &T::projection_tolerance)
        .positive()
        .at_most(1e-6)
        .doc("largest constraint residual left after a step, m or rad");
    f.add("max_events", &T::max_events)
        .at_least(1)
        .doc("events after which a run is aborted; for kinks of tables ten times as many, at least a million");
    return f;
  }();
  return table;
}

const FieldTable& OutputSettings::fields() {
  static const FieldTable table = [] {
    FieldTable f;
    f.add("step", &OutputSettings::step).in("s").positive().doc("time between two rows of the trajectory");
    f.add("channels", &OutputSettings::channels).doc("channels to write, patterns with * and ?; all if not given");
    f.add("also", &OutputSettings::also)
        .doc("channels that are made on request only (`steplap channels MODEL` lists them), patterns with * and ?: motion of markers, "
             "angle and power of joints, energies");
    f.add("most_numbers", &OutputSettings::most_numbers)
        .positive()
        .doc("a run whose trajectory would have more numbers, rows times channels, is not begun: each takes 8 bytes of disk while it runs "
             "and "
             "some 20 of trajectory.csv; 1e8 if not given");
    f.add("seen_from", &OutputSettings::seen_from)
        .as(FieldType::body)
        .doc("body that drawings stand still with, or 'ground'; chosen by the drawing if not given");
    return f;
  }();
  return table;
}

const FieldTable& Element::common_fields() {
  static const FieldTable table = [] {
    FieldTable f;
    f.add("draw", &Element::draw)
        .one_of({"auto", "hidden", "spring", "contact", "pin", "rail", "rod", "weld", "arrow", "friction"})
        .doc("how drawings show it; auto: as its kind is usually drawn");
    f.add("active", &Element::active).doc("it acts from the start; false: not before an [[action]] holds it");
    return f;
  }();
  return table;
}

const FieldTable& ModelHeader::fields() {
  static const FieldTable table = [] {
    FieldTable f;
    f.add("title", &ModelHeader::title).doc("one line that names the model");
    f.add("source", &ModelHeader::source).doc("where the values come from");
    f.add("gravity", &ModelHeader::gravity).in("m/s^2").doc("gravitational acceleration");
    return f;
  }();
  return table;
}

const Location& TableObject::place(const std::string& field) const {
  const auto found = places.find(field);
  return found == places.end() ? where : found->second;
}

const Body* Model::find_body(const std::string& name) const {
  for (const Body& body : bodies)
    if (body.name == name) return &body;
  return nullptr;
}

const ElementKind* Catalogue::find_element(const std::string& name) const {
  for (const ElementKind* kind : elements)
    if (kind->name == name) return kind;
  return nullptr;
}

} // namespace steplap
