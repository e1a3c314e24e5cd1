// Mechanisms with contacts: boxes on feet, on the ground or a driven deck; balls on hills, in rings, on plates.
#include "tests/random/scene_writer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap::random {

namespace {

using Fields = SceneWriter::Fields;

// Kelvin–Voigt, or Hunt–Crossley of the same force at `depth`; `is_flat`: a law of unilateral_contact.
void add_law(SceneWriter& w, Fields& fields, double m, double depth, bool is_flat) {
  const double k = w.stiffness_for(m, 6.0, 35.0), c = w.damping_for(m, k);
  if (w.r.chance(0.3)) {
    const double exponent = w.r.chance(0.5) ? 1.5 : 1.0;
    fields.push_back({"law", "\"hunt_crossley\""});
    fields.push_back({"exponent", number(exponent)});
    fields.push_back({"stiffness", number(k * std::pow(depth, 1.0 - exponent))});
    fields.push_back({"dissipation", number(w.r.decades(-2.0, 0.0) * w.duration / w.size)});
    return;
  }
  if (is_flat && w.r.chance(0.1)) fields.push_back({"law", "\"literal\""});
  fields.push_back({"stiffness", number(k)});
  fields.push_back({"damping", number(c)});
}

void friction_on(SceneWriter& w, const std::vector<std::string>& contacts, double least, double most) {
  const double mu = w.r.between(least, most);
  std::string names;
  for (const std::string& contact : contacts) names += (names.empty() ? "" : ", ") + quoted(contact);
  Fields fields{{"contacts", "[" + names + "]"}, {"static_friction", number(mu)}};
  if (w.r.chance(0.35)) fields.push_back({"kinetic_friction", number(mu * w.r.between(0.3, 0.95))});
  w.element("coulomb_stick", fields, contacts);
}

// Pressing: what its weight gives, or without gravity a load downwards.
double weight_of(SceneWriter& w, const std::string& box, double m) {
  if (w.gravity > 0.0) return m * w.gravity;
  const double force = m * w.size / (w.duration * w.duration) * 10.0;
  w.element("load", {{"at", quoted(box)}, {"force", pair(0.0, -force)}}, {box});
  return force;
}

// Two or three feet under a box of `wide` × `high`, friction for all or for each; `deck`: on what it stands.
void feet(SceneWriter& w, const std::string& box, At centre, double wide, double high, double m, const std::string& deck) {
  const int count = 2 + (w.r.chance(0.2) ? 1 : 0);
  const double weight = weight_of(w, box, m);
  std::vector<std::string> contacts;
  for (int i = 0; i < count; ++i) {
    const At foot{centre.x + wide * (i - 0.5 * (count - 1)) / (count - 1), centre.y - 0.5 * high};
    Fields fields{{"a", marker(box, foot)}, {"b", marker(deck, foot)}};
    add_law(w, fields, m / count, 0.02 * w.size, true);
    fields.push_back({"preload", number(weight / count)});
    std::vector<std::string> uses{box};
    if (deck != "ground") uses.push_back(deck);
    contacts.push_back(w.element("unilateral_contact", fields, uses));
  }
  const double least = 0.1, most = 0.8;
  if (w.r.chance(0.5)) return friction_on(w, contacts, least, most);
  for (const std::string& contact : contacts)
    if (w.r.chance(0.85)) friction_on(w, {contact}, least, most);
}

std::vector<std::string> box_on_ground(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass())), wide = w.size * w.r.between(0.5, 1.5), high = w.size * w.r.between(0.3, 1.2);
  const double speed = w.r.chance(0.5) ? w.r.either(0.05, 1.0) * w.size / w.duration : 0.0;
  const double spin = w.r.chance(0.4) ? w.r.either(0.01, 0.3) / w.duration : 0.0;
  const std::string box = w.body(m, w.inertia_of(m, w.size), place, {{"velocity", pair(speed, 0.0)}, {"angular_velocity", number(spin)}});
  feet(w, box, place, wide, high, m, "ground");
  const double force = std::max(w.gravity, 10.0 * w.size / (w.duration * w.duration)) * m * w.r.between(0.1, 0.8);
  if (w.r.chance(0.8)) {
    const std::string s = w.signal(force);
    w.element("load", {{"at", marker(box, {place.x, place.y + high * w.r.either(0.0, 0.3)})}, {"force_x", quoted(s)}}, {box, s});
  }
  return {box};
}

// A box on a deck that a drive brakes; arresting springs, sometimes with a gap; sometimes a second box on top.
std::vector<std::string> box_on_deck(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass())), wide = w.size * w.r.between(0.6, 1.5), high = w.size * w.r.between(0.3, 0.9);
  const At below{place.x, place.y - high};
  const double deck_mass = m * w.r.decades(-0.5, 1.0);
  const std::string deck = w.body(deck_mass, w.inertia_of(deck_mass, w.size), below);
  w.element("prismatic", {{"a", quoted(deck)}}, {deck});
  const double brake = std::max(w.gravity, 10.0 * w.size / (w.duration * w.duration)) * w.r.between(0.2, 1.0);
  if (w.r.chance(0.7)) {
    const std::string s = w.signal(brake, w.r.chance(0.5));
    w.element("prescribed_motion", {{"a", quoted(deck)}, {"signal", quoted(s)}}, {deck, s});
  } else {
    const double k = w.stiffness_for(m + deck_mass, 0.7, 10.0), c = w.damping_for(m, k);
    w.element("spring_damper",
              {{"a", quoted(deck)},
               {"b", marker("ground", {below.x + w.size, below.y})},
               {"axis", "[1.0, 0.0]"},
               {"stiffness", number(k)},
               {"damping", number(c)}},
              {deck});
    const std::string s = w.signal(brake * (m + deck_mass));
    w.element("load", {{"at", quoted(deck)}, {"force_x", quoted(s)}}, {deck, s});
  }
  const std::string box = w.body(m, w.inertia_of(m, w.size), place);
  feet(w, box, place, wide, high, m, deck);
  if (w.r.chance(0.6)) {
    const double k = w.stiffness_for(m, 2.0, 20.0), c = w.damping_for(m, k);
    Fields fields{{"a", quoted(box)}, {"b", marker(deck, place)}, {"axis", "[1.0, 0.0]"}, {"stiffness", number(k)}, {"damping", number(c)}};
    if (w.r.chance(0.5)) fields.push_back({"gap", number(0.02 * w.size * w.r.decades(-1.0, 0.5))});
    w.element("spring_damper", fields, {box, deck});
  }
  if (w.r.chance(0.25)) {
    const double m2 = std::stod(number(m * w.r.between(0.2, 1.0)));
    const At top{place.x, place.y + high};
    const std::string second = w.body(m2, w.inertia_of(m2, w.size), top);
    feet(w, second, top, 0.6 * wide, high, m2, box);
  }
  return {box};
}

// The gap at the start is that of a fall of some part of the run, so that it lands within it.
double drop(SceneWriter& w) {
  const double fall = w.r.between(0.0, 0.3) * w.duration;
  return std::min(0.5 * w.gravity * fall * fall + 0.01 * w.size, 0.7 * w.size);
}

void add_ball_friction(SceneWriter& w, const std::string& contact) {
  if (w.r.chance(0.7)) friction_on(w, {contact}, 0.05, 0.9);
}

Fields ball_velocity(SceneWriter& w) {
  const double v = w.size / w.duration, vx = w.r.either(0.0, 0.7) * v, vy = w.r.between(-1.0, 0.0) * v;
  return {{"velocity", pair(vx, w.gravity > 0.0 ? vy : -std::max(0.3 * v, -vy))},
          {"angular_velocity", number(w.r.chance(0.5) ? w.r.either(0.5, 10.0) / w.duration : 0.0)}};
}

std::string ball(SceneWriter& w, double m, double radius, At at) {
  const Fields moving = ball_velocity(w);
  return w.body(m, 0.4 * m * radius * radius, at, moving);
}

std::vector<std::string> ball_on_hill(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass())), ra = neat((w.size * w.r.between(0.1, 0.4))),
               rb = neat((w.size * w.r.between(0.5, 2.0)));
  const double away = w.r.either(0.0, 0.3), reach = ra + rb + drop(w);
  const std::string name = ball(w, m, ra, {place.x + reach * away, place.y + reach * std::sqrt(1.0 - away * away)});
  Fields fields{{"a", quoted(name)}, {"b", marker("ground", place)}, {"radius_a", number(ra)}, {"radius_b", number(rb)}};
  add_law(w, fields, m, 0.01 * w.size, false);
  add_ball_friction(w, w.element("circle_contact", fields, {name}));
  return {};
}

std::vector<std::string> ball_in_ring(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass())), ra = neat((w.size * w.r.between(0.1, 0.4))),
               rb = neat((w.size * w.r.between(0.8, 2.0)));
  const double away = w.r.either(0.0, 0.8), reach = (rb - ra) * w.r.between(0.5, 0.98);
  const std::string name = ball(w, m, ra, {place.x + reach * away, place.y - reach * std::sqrt(1.0 - away * away)});
  Fields fields{
      {"a", quoted(name)}, {"b", marker("ground", place)}, {"radius_a", number(ra)}, {"radius_b", number(rb)}, {"inside", "true"}};
  add_law(w, fields, m, 0.01 * w.size, false);
  add_ball_friction(w, w.element("circle_contact", fields, {name}));
  return {};
}

std::vector<std::string> ball_on_plate(SceneWriter& w, At place) {
  const double m = std::stod(number(w.some_mass())), radius = neat((w.size * w.r.between(0.1, 0.3))), thick = neat((0.05 * w.size));
  const double slope = w.r.between(-0.5, 0.5);
  const At start{place.x + w.size * w.r.either(0.0, 0.4), place.y + 0.5 * thick + (radius + drop(w)) * 1.2 + 0.25 * w.size};
  const std::string name = ball(w, m, radius, start);
  Fields fields{{"a", quoted(name)},
                {"b", marker("ground", place)},
                {"radius", number(radius)},
                {"from", pair(-w.size, -slope * 0.5 * w.size)},
                {"to", pair(w.size, slope * 0.5 * w.size)},
                {"thickness", number(thick)}};
  add_law(w, fields, m, 0.01 * w.size, false);
  add_ball_friction(w, w.element("segment_contact", fields, {name}));
  return {};
}

// Balls that knock together in free flight, or beside each other on rods.
std::vector<std::string> two_balls(SceneWriter& w, At place) {
  const double radius = neat((0.3 * w.size)), m1 = std::stod(number(w.some_mass())), m2 = std::stod(number(w.some_mass()));
  const double apart = 2.0 * radius + 0.2 * w.size, v = w.size / w.duration;
  const std::string a = w.body(m1, 0.4 * m1 * radius * radius, place, {{"velocity", pair(w.r.between(0.5, 2.0) * v, 0.0)}});
  const std::string b = w.body(m2, 0.4 * m2 * radius * radius, {place.x + apart, place.y + 0.15 * radius},
                               {{"angular_velocity", number(w.r.either(0.5, 5.0) / w.duration)}});
  Fields fields{{"a", quoted(a)}, {"b", quoted(b)}, {"radius_a", number(radius)}, {"radius_b", number(radius)}};
  add_law(w, fields, std::min(m1, m2), 0.01 * w.size, false);
  add_ball_friction(w, w.element("circle_contact", fields, {a, b}));
  return {};
}

} // namespace

const std::vector<NamedCell>& touching_cells() {
  static const std::vector<NamedCell> cells{{"box", box_on_ground},           {"deck", box_on_deck},
                                            {"hill", ball_on_hill},           {"ring", ball_in_ring},
                                            {"ball on plate", ball_on_plate}, {"two balls", two_balls}};
  return cells;
}

} // namespace steplap::random
