// Mechanisms that slide on rails, on springs, and joints of sheets.
#include "tests/random/scene_writer.h"

#include <algorithm>
#include <cmath>

namespace steplap::random {

namespace {

using Fields = SceneWriter::Fields;

// A force that moves m by about the scene's size within the run.
double push(const SceneWriter& w, double m) { return m * w.size / (w.duration * w.duration) * 4.0; }

// Along `axis` against the ground or another body; all characteristics that springs have.
void spring(SceneWriter& w, const std::string& a, At at_a, const std::string& b, At at_b, double m, const std::string& axis) {
  const double k = w.stiffness_for(m, 0.7, 25.0), c = w.damping_for(m, k), reach = w.size * w.r.decades(-1.5, -0.3);
  Fields fields{{"a", marker(a, at_a)}, {"b", marker(b, at_b)}};
  std::vector<std::string> uses{a};
  if (b != "ground") uses.push_back(b);
  if (!axis.empty()) fields.push_back({"axis", axis});
  bool is_gapped = false;
  if (w.r.chance(0.3)) {
    const double soft = k * w.r.between(0.05, 0.9);
    fields.push_back({"force_table", "[" + pair(-2.0 * reach, -reach * (k + soft)) + ", " + pair(-reach, -reach * k) + ", [0.0, 0.0], " +
                                         pair(reach, reach * soft) + ", " + pair(3.0 * reach, reach * (soft + 2.0 * k)) + "]"});
  } else {
    fields.push_back({"stiffness", number(k)});
    is_gapped = w.r.chance(0.3);
    if (is_gapped) fields.push_back({"gap", number(reach * w.r.between(0.05, 1.0))});
    else if (w.r.chance(0.3)) fields.push_back({"preload", number(k * reach * w.r.either(0.05, 1.0))});
    if (w.r.chance(0.2)) fields.push_back({"count", "2"});
  }
  if (!is_gapped && w.r.chance(0.25)) {
    const double v = w.size / w.duration, d = std::max(c, 0.1 * std::sqrt(k * m));
    fields.push_back({"damping_table", "[" + pair(-v, -0.4 * d * v) + ", " + pair(-0.2 * v, -0.2 * d * v) + ", [0.0, 0.0], " +
                                           pair(0.1 * v, 0.1 * d * v) + ", " + pair(v, 0.7 * d * v) + "]"});
  } else {
    fields.push_back({"damping", number(c)});
  }
  w.element("spring_damper", fields, uses);
}

std::string cart_on(SceneWriter& w, At place, double m, const std::string& axis, double speed) {
  const std::string cart = w.body(m, w.inertia_of(m, w.size), place, {{"velocity", pair(speed, 0.0)}});
  w.element("prismatic", {{"a", marker(cart, place)}, {"b", marker("ground", place)}, {"axis", axis}}, {cart});
  return cart;
}

// On a rail, straight or sloping, held by friction, springs and stops.
std::vector<std::string> cart(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass()));
  const bool is_level = w.r.chance(0.5);
  const std::string name =
      cart_on(w, place, m, is_level ? "[1.0, 0.0]" : "[0.8, -0.6]", w.r.chance(0.5) ? w.r.either(0.1, 2.0) * w.size / w.duration : 0.0);
  const double force = is_level ? push(w, m) : std::max(push(w, m), 0.6 * m * w.gravity);
  if (w.r.chance(0.8)) {
    const double holds = force * w.r.decades(-1.0, 0.2);
    Fields fields{{"a", marker(name, place)},
                  {"b", "{ body = \"ground\", at = " + pair(place.x, place.y) + (is_level ? " }" : ", angle = -0.6435011087932844 }")},
                  {"coordinate", "\"x\""},
                  {"holds", number(holds)}};
    if (w.r.chance(0.3)) fields.push_back({"drags", number(holds * w.r.between(0.2, 0.9))});
    w.element("joint_friction", fields, {name});
  }
  if (w.r.chance(0.7)) spring(w, name, place, "ground", {place.x + w.size, place.y}, m, w.r.chance(0.5) ? "[1.0, 0.0]" : "");
  if (w.r.chance(0.4)) {
    const double k = w.stiffness_for(m, 5.0, 30.0), c = w.damping_for(m, k);
    w.element("limit",
              {{"a", marker(name, place)},
               {"b", marker("ground", place)},
               {"coordinate", "\"x\""},
               {"upper", number(w.size * w.r.decades(-2.0, -0.3))},
               {"lower", number(-w.size * w.r.decades(-2.0, -0.3))},
               {"stiffness", number(k)},
               {"damping", number(c)}},
              {name});
  }
  const std::string s = w.signal(force * w.r.between(0.4, 2.0));
  w.element("load", {{"at", quoted(name)}, {"force_x", quoted(s)}}, {name, s});
  return {name};
}

// Masses in a row on springs, friction between them: several sticking and sliding at a time.
std::vector<std::string> train(SceneWriter& w, At place) {
  const int count = 2 + w.r.below(2);
  std::string last;
  double last_mass = 0.0;
  for (int i = 0; i < count; ++i) {
    const At at{place.x + i * w.size, place.y};
    const double m = std::stod(number(w.some_mass()));
    const std::string name = cart_on(w, at, m, "[1.0, 0.0]", w.r.chance(0.5) ? w.r.either(0.1, 2.0) * w.size / w.duration : 0.0);
    if (w.r.chance(0.6))
      w.element("joint_friction", {{"a", quoted(name)}, {"coordinate", "\"x\""}, {"holds", number(push(w, m) * w.r.decades(-1.0, 0.0))}},
                {name});
    if (i > 0) {
      const At before{at.x - w.size, at.y};
      spring(w, name, at, last, before, std::min(m, last_mass), w.r.chance(0.5) ? "[1.0, 0.0]" : "");
      if (w.r.chance(0.5))
        w.element(
            "joint_friction",
            {{"a", quoted(name)}, {"b", quoted(last)}, {"coordinate", "\"x\""}, {"holds", number(push(w, m) * w.r.decades(-1.0, 0.0))}},
            {name, last});
    }
    if (w.r.chance(0.6)) {
      const std::string s = w.signal(push(w, m) * w.r.between(0.4, 2.0));
      w.element("load", {{"at", quoted(name)}, {"force_x", quoted(s)}}, {name, s});
    }
    last = name;
    last_mass = m;
  }
  return {last};
}

// A plate on springs in both directions, welded to a second body or alone.
std::vector<std::string> plate(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass()));
  const std::string name = w.body(m, w.inertia_of(m, w.size), place);
  const double h = 0.5 * w.size;
  spring(w, name, {place.x - h, place.y}, "ground", {place.x - h, place.y - h}, m, "[0.0, 1.0]");
  spring(w, name, {place.x + h, place.y}, "ground", {place.x + h, place.y - h}, m, "[0.0, 1.0]");
  const double k = w.stiffness_for(m, 1.0, 15.0), c = w.damping_for(m, k);
  w.element("bushing",
            {{"a", quoted(name)},
             {"b", marker("ground", place)},
             {"stiffness", pair(k, 0.3 * k)},
             {"damping", pair(c, c)},
             {"rotational_stiffness", number(k * h * h)}},
            {name});
  if (w.r.chance(0.5)) {
    const double m2 = w.some_mass();
    const std::string second = w.body(m2, w.inertia_of(m2, w.size), {place.x, place.y + h});
    w.element("weld", {{"a", quoted(second)}, {"b", quoted(name)}}, {second, name});
  }
  const std::string s = w.signal(push(w, m) * w.r.decades(-0.5, 1.0));
  w.element("load",
            {{"at", marker(name, {place.x + h, place.y})}, {"force_y", quoted(s)}, {"frame", w.r.chance(0.5) ? "\"ground\"" : "\"body\""}},
            {name, s});
  return {name};
}

// A limb between two yokes, held by sheets; the yokes on a driven base, or pulled from.
std::vector<std::string> step_lap(SceneWriter& w, At place) {
  const double width = neat((w.size * w.r.between(0.3, 0.6))), high = w.size, lap = neat((0.15 * w.size));
  const double m = std::stod(number(w.some_mass()));
  const std::string yokes = w.body(m * 2.0, w.inertia_of(m, w.size), place);
  const std::string limb = w.body(m, m * w.size * w.size / 6.0, place);
  w.element("prismatic", {{"a", quoted(yokes)}}, {yokes});
  const double hold = std::max(1.4 * w.gravity, lap / (w.duration * w.duration) * 4.0) * w.r.between(1.0, 3.0); // m/s²
  const std::string joint =
      w.element("step_lap_joint", {{"limb", quoted(limb)}, {"active_part", quoted(yokes)}, {"on_apart", "\"continue\""}}, {limb, yokes});
  const double mu = w.r.between(0.1, 0.5);
  const double pressure = hold * m / (2.0 * mu * lap * width * 100.0);
  const auto box = [](double x0, double y0, double x1, double y1) {
    return "[" + pair(x0, y0) + ", " + pair(x1, y0) + ", " + pair(x1, y1) + ", " + pair(x0, y1) + "]";
  };
  const double slant = w.r.chance(0.3) ? 0.3 : 1.0; // a softer corner at one end
  for (const double side : {1.0, -1.0}) {
    const double y = place.y + side * 0.5 * high, inner = y - side * lap, x0 = place.x - 0.5 * width, x1 = place.x + 0.5 * width;
    w.element("step_lap_interface",
              {{"joint", quoted(joint)},
               {"yoke", box(x0 - width, std::min(inner, y + side * lap), x1 + width, std::max(inner, y + side * lap))},
               {"limb", box(x0, std::min(y, place.y), x1, std::max(y, place.y))},
               {"count", "100"},
               {"pressure", number(pressure * (side > 0.0 ? 1.0 : slant))},
               {"static_friction", number(mu)}},
              {joint});
  }
  const double most = hold * w.r.between(0.5, 1.5);
  if (w.r.chance(0.6)) {
    const double length = std::min(w.duration * 0.5, 2.5 * std::sqrt(lap / most));
    const std::string name = "brake" + std::to_string(w.scene.blocks.size());
    w.scene.blocks.push_back({"signal",
                              "haversine",
                              name,
                              "peak = " + number(-most) + "\nstart = " + number(0.1 * w.duration) + "\nduration = " + number(length) + "\n",
                              {}});
    w.element("prescribed_motion", {{"a", quoted(yokes)}, {"signal", quoted(name)}}, {yokes, name});
  } else {
    const double k = w.stiffness_for(3.0 * m, 1.0, 15.0), c = w.damping_for(m, k);
    w.element("spring_damper",
              {{"a", quoted(yokes)},
               {"b", marker("ground", {place.x + w.size, place.y})},
               {"axis", "[1.0, 0.0]"},
               {"stiffness", number(k)},
               {"damping", number(c)}},
              {yokes});
    const std::string s = w.signal(most * m * w.r.between(0.5, 1.0), true);
    w.element("load", {{"at", marker(limb, {place.x, place.y + w.r.either(0.0, 0.3) * w.size})}, {"force_x", quoted(s)}}, {limb, s});
  }
  return {yokes};
}

// Two bodies in free flight: momentum and angular momentum are conserved whatever is between them.
std::vector<std::string> free_pair(SceneWriter& w, At place) {
  const double m1 = std::stod(number(w.some_mass())), m2 = std::stod(number(w.some_mass())), v = w.size / w.duration;
  const At second{place.x + w.size, place.y};
  const double vx = w.r.either(0.1, 1.0) * v, vy = w.r.either(0.1, 1.0) * v;
  const double spin1 = w.r.either(0.1, 3.0) / w.duration, spin2 = w.r.either(0.1, 3.0) / w.duration;
  const std::string a = w.body(m1, w.inertia_of(m1, w.size), place, {{"velocity", pair(vx, vy)}, {"angular_velocity", number(spin1)}});
  const std::string b = w.body(m2, w.inertia_of(m2, w.size), second, {{"angular_velocity", number(spin2)}});
  const At middle{place.x + 0.5 * w.size, place.y};
  switch (w.r.below(3)) {
  case 0:
    w.element("revolute", {{"a", marker(b, middle)}, {"b", marker(a, middle)}}, {a, b});
    w.element("joint_friction",
              {{"a", quoted(b)}, {"b", quoted(a)}, {"holds", number(push(w, std::min(m1, m2)) * w.size * w.r.decades(-2.0, -0.3))}},
              {a, b});
    break;
  case 1: spring(w, b, second, a, place, std::min(m1, m2), ""); break;
  default:
    w.element("prismatic", {{"a", quoted(b)}, {"b", quoted(a)}}, {a, b});
    spring(w, b, second, a, place, std::min(m1, m2), "");
    w.element("joint_friction",
              {{"a", quoted(b)},
               {"b", quoted(a)},
               {"coordinate", "\"x\""},
               {"holds", number(push(w, std::min(m1, m2)) * w.r.decades(-1.5, -0.3))}},
              {a, b});
  }
  return {};
}

} // namespace

const std::vector<NamedCell>& sliding_cells() {
  static const std::vector<NamedCell> cells{
      {"cart", cart}, {"train", train}, {"plate", plate}, {"step lap", step_lap}, {"free pair", free_pair}};
  return cells;
}

} // namespace steplap::random
