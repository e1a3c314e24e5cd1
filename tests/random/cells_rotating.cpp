// Mechanisms that turn: wheels, gears, pendulums, cranks, drives.
#include "tests/random/scene_writer.h"

#include <cmath>

namespace steplap::random {

namespace {

using Fields = SceneWriter::Fields;

// A wheel on a pin; its bearing holds `bound`, an inertia that such couples move visibly.
struct Wheel {
  std::string name;
  double inertia = 0.0, bound = 0.0;
};

Wheel wheel(SceneWriter& w, At at, bool is_moving) {
  Wheel made;
  made.bound = w.mass * w.size * 10.0 * w.r.decades(-1.0, 1.0);
  made.inertia = std::stod(number(made.bound * w.duration * w.duration * w.r.decades(-2.0, 0.5)));
  const double spin = is_moving ? w.r.either(0.2, 3.0) / w.duration : 0.0;
  const double m = w.some_mass();
  made.name = w.body(m, made.inertia, at, {{"angular_velocity", number(spin)}});
  w.element("revolute", {{"a", marker(made.name, at)}, {"b", marker("ground", at)}}, {made.name});
  return made;
}

void bearing(SceneWriter& w, const Wheel& on) {
  const double holds = on.bound * w.r.between(0.3, 1.0);
  Fields fields{{"a", quoted(on.name)}, {"holds", number(holds)}};
  if (w.r.chance(0.4)) fields.push_back({"drags", number(holds * w.r.between(0.1, 0.95))});
  w.element("joint_friction", fields, {on.name});
}

void couple(SceneWriter& w, const Wheel& on, double share) {
  const std::string s = w.signal(on.bound * share);
  w.element("load", {{"at", quoted(on.name)}, {"torque", quoted(s)}}, {on.name, s});
}

void turn_spring(SceneWriter& w, const std::string& a, const std::string& b, double inertia) {
  const double k = w.stiffness_for(inertia, 0.5, 20.0), c = w.damping_for(inertia, k);
  std::vector<std::string> uses{a};
  Fields fields{{"a", quoted(a)}, {"stiffness", number(k)}, {"damping", number(c)}};
  if (!b.empty()) {
    fields.push_back({"b", quoted(b)});
    uses.push_back(b);
  }
  if (w.r.chance(0.3)) fields.push_back({"free_angle", number(w.r.either(0.01, 0.5))});
  w.element("rotational_spring_damper", fields, uses);
}

void stops(SceneWriter& w, const std::string& a, double inertia, double reach) {
  const double k = w.stiffness_for(inertia, 3.0, 30.0), c = w.damping_for(inertia, k);
  Fields fields{{"a", quoted(a)}, {"coordinate", "\"angle\""}, {"stiffness", number(k)}, {"damping", number(c)}};
  fields.push_back({"upper", number(reach * w.r.between(0.1, 1.0))});
  if (w.r.chance(0.6)) fields.push_back({"lower", number(-reach * w.r.between(0.1, 1.0))});
  w.element("limit", fields, {a});
}

// Held by its bearing under loads of several frequencies.
std::vector<std::string> held_wheel(SceneWriter& w, At place) {
  const Wheel a = wheel(w, place, w.r.chance(0.3));
  bearing(w, a);
  couple(w, a, w.r.between(0.6, 1.8));
  if (w.r.chance(0.3)) couple(w, a, w.r.between(0.1, 0.6));
  if (w.r.chance(0.3)) turn_spring(w, a.name, "", a.inertia);
  return {a.name};
}

std::vector<std::string> stopped_wheel(SceneWriter& w, At place) {
  const Wheel a = wheel(w, place, true);
  stops(w, a.name, a.inertia, 1.0);
  if (w.r.chance(0.5)) bearing(w, a);
  couple(w, a, w.r.between(0.3, 1.5));
  return {a.name};
}

// Pitch circles touch: the second wheel stands at the sum of the radii, or inside the ring.
std::vector<std::string> gears(SceneWriter& w, At place) {
  const bool is_ring = w.r.chance(0.25);
  const double ra = neat((w.size * w.r.between(0.2, 0.5)));
  const double rb = neat((w.size * (is_ring ? w.r.between(0.6, 1.0) : w.r.between(0.1, 0.5))));
  const double apart = is_ring ? rb - ra : ra + rb;
  const Wheel a = wheel(w, place, w.r.chance(0.5));
  const Wheel b = wheel(w, {place.x + apart, place.y}, w.r.chance(0.3));
  Fields fields{
      {"a", marker(a.name, place)}, {"b", marker(b.name, {place.x + apart, place.y})}, {"radius_a", number(ra)}, {"radius_b", number(rb)}};
  if (is_ring) fields.push_back({"inside", "true"});
  w.element("gear", fields, {a.name, b.name});
  if (w.r.chance(0.8)) bearing(w, a);
  if (w.r.chance(0.8)) bearing(w, b);
  couple(w, a, w.r.between(0.5, 2.0));
  if (w.r.chance(0.4)) stops(w, b.name, b.inertia, 0.7);
  if (w.r.chance(0.3)) turn_spring(w, b.name, "", b.inertia);
  return {a.name, b.name};
}

std::vector<std::string> rack_and_pinion(SceneWriter& w, At place) {
  const double radius = neat((w.size * w.r.between(0.1, 0.4)));
  const Wheel pinion = wheel(w, {place.x, place.y + radius}, w.r.chance(0.4));
  const double m = std::stod(number(pinion.inertia / (radius * radius) * w.r.decades(-1.0, 1.0)));
  const std::string rack = w.body(m, m * w.size * w.size, place);
  w.element("prismatic", {{"a", quoted(rack)}}, {rack});
  w.element("rack", {{"a", quoted(pinion.name)}, {"b", quoted(rack)}, {"radius", number(radius)}}, {pinion.name, rack});
  if (w.r.chance(0.7)) bearing(w, pinion);
  if (w.r.chance(0.7))
    w.element("joint_friction",
              {{"a", quoted(rack)}, {"coordinate", "\"x\""}, {"holds", number(pinion.bound / radius * w.r.decades(-1.0, 0.0))}}, {rack});
  couple(w, pinion, w.r.between(0.6, 2.0));
  return {rack};
}

std::vector<std::string> motor_wheel(SceneWriter& w, At place) {
  const Wheel a = wheel(w, place, false);
  Fields fields{{"a", quoted(a.name)}};
  std::vector<std::string> uses{a.name};
  if (w.r.chance(0.5)) {
    const std::string s = w.signal(a.bound * w.r.between(0.5, 3.0));
    fields.push_back({"effort", quoted(s)});
    uses.push_back(s);
  } else {
    fields.push_back({"constant_effort", number(a.bound * w.r.either(0.5, 3.0))});
  }
  if (w.r.chance(0.5)) fields.push_back({"no_load_speed", number(w.r.decades(0.0, 1.5) / w.duration)});
  if (w.r.chance(0.5)) {
    const std::string s = w.signal(w.r.either(0.1, 1.0), true);
    const double k = w.stiffness_for(a.inertia, 1.0, 10.0);
    fields.push_back({"target", quoted(s)});
    fields.push_back({"proportional", number(k)});
    fields.push_back({"derivative", number(w.damping_for(a.inertia, k))});
    uses.push_back(s);
  }
  w.element("motor", fields, uses);
  if (w.r.chance(0.7)) bearing(w, a);
  if (w.r.chance(0.4)) stops(w, a.name, a.inertia, 1.0);
  return {a.name};
}

// Turned by a drive against the friction of its bearing.
std::vector<std::string> driven_wheel(SceneWriter& w, At place) {
  const Wheel a = wheel(w, place, false);
  const bool is_position = w.r.chance(0.3);
  const std::string s = w.signal(is_position ? 0.5 : w.r.decades(-0.3, 0.7) / w.duration, true);
  w.element(
      "prescribed_motion",
      {{"a", quoted(a.name)}, {"coordinate", "\"angle\""}, {"signal", quoted(s)}, {"as", is_position ? "\"position\"" : "\"velocity\""}},
      {a.name, s});
  if (w.r.chance(0.7)) bearing(w, a);
  const Wheel b = wheel(w, {place.x, place.y + w.size}, false);
  turn_spring(w, b.name, a.name, b.inertia);
  if (w.r.chance(0.6)) bearing(w, b);
  return {b.name};
}

// Links hung from each other, with friction, springs, bushings or stops in their pins.
std::vector<std::string> pendulum(SceneWriter& w, At place) {
  const int count = 1 + w.r.below(3);
  // Long enough that it swings a few times at most.
  const double length = neat((std::max(w.size, 0.05 * w.gravity * w.duration * w.duration)));
  const bool is_flat = w.r.chance(0.5);
  std::string above;
  At pin = place;
  for (int i = 0; i < count; ++i) {
    const At step = is_flat ? At{length, 0.0} : At{0.6 * length, -0.8 * length};
    const At centre{pin.x + 0.5 * step.x, pin.y + 0.5 * step.y};
    const double m = w.some_mass(), inertia = m * length * length / 12.0;
    const double spin = w.r.chance(0.6) ? w.r.either(0.1, 2.0) / w.duration : 0.0;
    const std::string link = w.body(m, inertia, centre, {{"angular_velocity", number(spin)}});
    const std::string b = above.empty() ? "ground" : above;
    std::vector<std::string> uses{link};
    if (!above.empty()) uses.push_back(above);
    const Fields ends{{"a", marker(link, pin)}, {"b", marker(b, pin)}};
    if (i > 0 && w.r.chance(0.25)) {
      const double k = w.stiffness_for(m, 5.0, 30.0), c = w.damping_for(m, k);
      Fields fields = ends;
      fields.push_back({"stiffness", pair(k, 0.7 * k)});
      fields.push_back({"damping", pair(c, c)});
      fields.push_back({"rotational_stiffness", number(k * length * length * w.r.decades(-3.0, -1.0))});
      w.element("bushing", fields, uses);
    } else {
      w.element("revolute", ends, uses);
    }
    const double weight = m * std::max(w.gravity, length / (w.duration * w.duration)) * length;
    if (w.r.chance(0.5)) {
      const double holds = weight * w.r.decades(-1.5, 0.2);
      Fields fields = ends;
      fields.push_back({"holds", number(holds)});
      if (w.r.chance(0.3)) fields.push_back({"drags", number(holds * w.r.between(0.2, 0.9))});
      w.element("joint_friction", fields, uses);
    }
    if (w.r.chance(0.3)) {
      const double k = w.stiffness_for(inertia, 3.0, 25.0), c = w.damping_for(inertia, k);
      Fields fields = ends;
      fields.push_back({"coordinate", "\"angle\""});
      fields.push_back({"upper", number(w.r.between(0.05, 0.8))});
      fields.push_back({"lower", number(-w.r.between(0.05, 0.8))});
      fields.push_back({"stiffness", number(k)});
      fields.push_back({"damping", number(c)});
      w.element("limit", fields, uses);
    }
    above = link;
    pin = {pin.x + step.x, pin.y + step.y};
  }
  return {above};
}

// A crank, a massless rod, a slider on a line: distance and point_on_line, or a rod of its own.
std::vector<std::string> crank(SceneWriter& w, At place) {
  const double radius = neat((0.3 * w.size));
  const double m = w.some_mass();
  const std::string turning = w.body(m, m * radius * radius, place, {{"angular_velocity", number(w.r.either(0.5, 8.0) / w.duration)}});
  w.element("revolute", {{"a", marker(turning, place)}, {"b", marker("ground", place)}}, {turning});
  const At pin{place.x, place.y + radius}, end{place.x + 4.0 * radius, place.y};
  const double m2 = w.some_mass();
  const std::string slider = w.body(m2, m2 * radius * radius, end);
  if (w.r.chance(0.5)) {
    w.element("prismatic", {{"a", marker(slider, end)}, {"b", marker("ground", end)}}, {slider});
  } else {
    w.element("point_on_line", {{"a", marker(slider, end)}, {"b", marker("ground", end)}}, {slider});
    turn_spring(w, slider, "", m2 * radius * radius);
  }
  w.element("distance", {{"a", marker(turning, pin)}, {"b", marker(slider, end)}}, {turning, slider});
  const double force = m2 * radius * std::pow(4.0 / w.duration, 2);
  if (w.r.chance(0.6))
    w.element("joint_friction",
              {{"a", marker(slider, end)},
               {"b", marker("ground", end)},
               {"coordinate", "\"x\""},
               {"holds", number(force * w.r.decades(-1.5, 0.5))}},
              {slider});
  if (w.r.chance(0.5)) {
    const std::string s = w.signal(force * w.r.between(0.5, 4.0));
    w.element("load", {{"at", quoted(slider)}, {"force_x", quoted(s)}}, {slider, s});
  }
  return {slider};
}

} // namespace

const std::vector<NamedCell>& rotating_cells() {
  static const std::vector<NamedCell> cells{
      {"held wheel", held_wheel}, {"stopped wheel", stopped_wheel}, {"gears", gears},       {"rack", rack_and_pinion},
      {"motor", motor_wheel},     {"driven wheel", driven_wheel},   {"pendulum", pendulum}, {"crank", crank}};
  return cells;
}

} // namespace steplap::random
