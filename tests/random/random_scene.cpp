#include "tests/random/random_scene.h"

#include "tests/random/scene_writer.h"
#include "tests/random/transmissions.h"

#include <algorithm>
#include <cmath>

namespace steplap::random {

namespace {

// From the bodies of one mechanism to those of another.
void couple(SceneWriter& w, const std::string& a, const std::string& b) {
  const double k = w.stiffness_for(w.mass, 0.5, 8.0), c = w.damping_for(w.mass, k);
  if (w.r.chance(0.7))
    w.element("spring_damper", {{"a", quoted(a)}, {"b", quoted(b)}, {"stiffness", number(k)}, {"damping", number(c)}}, {a, b});
  else w.element("bushing", {{"a", quoted(a)}, {"b", quoted(b)}, {"stiffness", pair(k, k)}, {"damping", pair(c, c)}}, {a, b});
}

// A rope to something above or a tie to something below: in a few scenes, drawn from a stream of
// its own, so that all that is drawn otherwise stays what it was.
void hold(SceneWriter& w, RandomNumber own, const std::string& body) {
  constexpr double k_some = 0.1;
  if (!own.chance(k_some)) return;
  const double length = neat(w.size * own.between(2.0, 4.0)), aside = neat(w.size * own.between(0.5, 2.0));
  const double k = w.mass * 4.0 * own.between(1.0, 100.0) * std::max(w.gravity / w.size, 1.0 / (w.duration * w.duration));
  const double c = own.chance(0.5) ? 0.02 * std::sqrt(k * w.mass) : 0.0;
  SceneWriter::Fields fields{{"a", quoted(body)}, {"stiffness", number(k)}, {"damping", number(c)}};
  if (own.chance(0.5)) {
    fields.push_back({"b", marker("ground", {aside, length})});
    if (own.chance(0.5)) fields.push_back({"slack", number(0.05 * w.size)});
    const bool is_wound = own.chance(0.25); // on a drum that stands still
    if (is_wound) fields.push_back({"radius_b", number((own.chance(0.5) ? 0.2 : -0.2) * w.size)});
    w.element(is_wound ? "wound_rope" : "rope", fields, {body});
  } else {
    fields.push_back({"b", marker("ground", {aside, -length})});
    fields.push_back({"acts", quoted(own.one_of<std::string>({"tension", "compression", "both"}))});
    if (own.chance(0.5)) fields.push_back({"slack", number(0.05 * w.size)});
    w.element("tie", fields, {body});
  }
}

// A convex outline that falls on the ground beside everything else: in a few scenes, drawn from a stream of its own.
void drop(SceneWriter& w, RandomNumber own) {
  constexpr double k_some = 0.1, k_depth = 1e-3; // how deep it sinks at rest, of its size
  if (!own.chance(k_some)) return;
  const int corners = 3 + own.below(4);
  const double radius = 0.5 * w.size, turn = own.between(0.0, 6.0), m = w.mass * own.between(0.5, 2.0);
  std::string outline = "[";
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 6.283185307179586 * (i + 0.3 * own.between(-1.0, 1.0)) / corners;
    outline += (i > 0 ? ", " : "") + pair(neat(radius * std::cos(angle)), neat(radius * std::sin(angle)));
  }
  const double speed = w.size / w.duration;
  const double height = own.between(1.05, 2.0) * radius, along = speed * own.between(-2.0, 2.0);
  const std::string body =
      w.body(m, 0.4 * m * radius * radius, {-10.0 * w.size, height}, {{"outline", outline + "]"}, {"velocity", pair(along, 0.0)}});
  const double weight = m * std::max(w.gravity, speed * speed / w.size);
  SceneWriter::Fields fields{{"a", quoted(body)}, {"stiffness", number(weight / (k_depth * w.size * w.size))}};
  if (own.chance(0.7)) fields.push_back({"static_friction", number(own.between(0.05, 0.8))});
  if (own.chance(0.5)) fields.push_back({"dissipation", number(own.between(0.01, 0.2) / speed)});
  w.element("polygon_contact", fields, {body});
}

// Scenes behind this seed hold a buffer, a force by formula and friction with a law of its own as well.
constexpr std::uint64_t k_last_without_laws = 3000;

// A buffer against a wall beside the body, with curves of its mass and of what it may run into in the scene's time.
void buffer_beside(SceneWriter& w, RandomNumber& own, const std::string& body) {
  const double slope = w.stiffness_for(w.mass, 1.0, 10.0), corner = w.size * own.between(0.02, 0.2);
  const double share = own.between(0.1, 0.9), gap = w.size * own.between(-0.01, 0.1);
  const bool is_left = own.chance(0.5);
  w.element("buffer",
            {{"a", quoted(body)},
             {"axis", is_left ? "[1.0, 0.0]" : "[-1.0, 0.0]"},
             {"gap", number(gap)},
             {"loading", "[[0.0, 0.0], " + pair(corner, slope * corner) + ", " + pair(2.0 * corner, 3.0 * slope * corner) + "]"},
             {"unloading", "[[0.0, 0.0], " + pair(1.3 * corner, share * slope * corner) + "]"}},
            {body});
}

// Drag of the square of the velocity, or a spring that hardens and ends at some force.
void formula_on(SceneWriter& w, RandomNumber& own, const std::string& body) {
  const double speed = w.size / w.duration, force = w.mass * speed / w.duration * own.decades(-1.0, 0.7);
  const std::string axis = own.chance(0.5) ? "\"x\"" : "\"y\"";
  if (own.chance(0.5)) {
    const std::string formula = "\"-'" + number(force / (speed * speed)) + " N s2/m2' * abs(rate) * rate\"";
    w.element("force", {{"a", quoted(body)}, {"coordinate", axis}, {"formula", formula}, {"energy", "\"dissipated\""}}, {body});
  } else {
    const std::string law = "'" + number(force / w.size) + " N/m' * (value - '" + number(w.size * own.between(-1.0, 1.0)) + " m')";
    w.element("force",
              {{"a", quoted(body)},
               {"coordinate", axis},
               {"formula", "\"-max(-'" + number(force) + " N', min('" + number(force) + " N', " + law + "))\""}},
              {body});
  }
}

// A brake on a coordinate, pressed by a pulse, with a law of its own.
void brake_on(SceneWriter& w, RandomNumber& own, const std::string& body) {
  const double speed = w.size / w.duration, holds = w.mass * speed / w.duration * own.decades(-1.0, 1.0);
  SceneWriter::Fields fields{
      {"a", quoted(body)}, {"coordinate", "\"x\""}, {"holds", number(holds)}, {"drags", number(holds * own.between(0.3, 0.95))}};
  if (own.chance(0.5)) fields.push_back({"stribeck_velocity", number(speed * own.decades(-2.0, 0.0))});
  if (own.chance(0.5)) fields.push_back({"viscous", number(holds / speed * own.decades(-2.0, 0.0))});
  w.element("joint_friction", fields, {body});
}

void add_laws(SceneWriter& w, RandomNumber own, const std::string& body) {
  if (own.chance(0.6)) buffer_beside(w, own, body);
  if (own.chance(0.6)) formula_on(w, own, body);
  if (own.chance(0.4)) brake_on(w, own, body);
}

// Scenes behind this seed have a belt, a band, a cam, a one-way clutch, a gear with losses or a part of a beam as well.
constexpr std::uint64_t k_last_without_transmissions = 12000;
// Scenes behind this seed have a bearing with friction and a pad that creeps as well.
constexpr std::uint64_t k_last_without_bearings = 18000;
// Scenes behind this seed have actions as well.
constexpr std::uint64_t k_last_without_actions = 9000;

// When something happens: at a time, or where the body has moved or turned, once the time has come.
std::string condition(SceneWriter& w, RandomNumber& own, const std::string& body) {
  const std::string time = number(w.duration * own.between(0.1, 0.9));
  if (own.chance(0.4)) return quoted(time + " s");
  const char* const quantity = own.chance(0.5) ? "vx" : "omega";
  // Not zero: what joints or friction hold at rest is zero to rounding, and whether that is more or less nobody can tell.
  const double limit = own.either(0.05, 1.0) / w.duration;
  const std::string than = std::string(quantity) == "vx" ? "'" + number(limit * w.size) + " m/s'" : "'" + number(limit) + " rad/s'";
  return "\"t > '" + time + " s' && " + body + "." + quantity + (own.chance(0.5) ? " > " : " < ") + than + "\"";
}

// Some element lets go, and may hold again. A brake may be set, and the run may end before its time.
void add_actions(SceneWriter& w, RandomNumber own, const std::string& body) {
  std::vector<Block> elements;
  for (const Block& block : w.scene.blocks)
    if (block.table == "element") elements.push_back(block);
  if (elements.empty()) return;
  const Block chosen = own.one_of(elements);
  const std::string& released = chosen.name;
  const char* const k_have_to_fit[] = {"revolute",   "point_on_line",    "gear", "rack", "rope",
                                       "wound_rope", "prescribed_motion"}; // where they close
  w.action({{"when", condition(w, own, body)}, {"do", "[\"release " + released + "\"]"}}, {released, body});
  const bool fits = std::none_of(std::begin(k_have_to_fit), std::end(k_have_to_fit), [&](const char* kind) { return chosen.kind == kind; });
  if (fits && own.chance(0.5)) w.action({{"when", condition(w, own, body)}, {"do", "[\"hold " + released + "\"]"}}, {released, body});
  if (own.chance(0.4)) {
    const std::string brace = w.element("joint_friction",
                                        {{"a", quoted(body)},
                                         {"coordinate", "\"angle\""},
                                         {"holds", number(w.mass * w.size * w.size / (w.duration * w.duration) * own.decades(-1.0, 1.0))},
                                         {"active", "false"}},
                                        {body});
    w.action({{"when", condition(w, own, body)}, {"do", "[\"hold " + brace + "\"]"}}, {brace, body});
  }
  if (own.chance(0.2)) w.action({{"when", quoted(number(w.duration * own.between(0.8, 1.0)) + " s")}, {"do", "[\"stop\"]"}}, {body});
}

// Scenes behind this seed, and before those with actions, hold a wheel on a road, or something on a skate, as well.
constexpr std::uint64_t k_last_without_wheels = 6000;

// A wheel that falls on a road beside everything else, rolling, sliding or spinning.
void roll(SceneWriter& w, RandomNumber& own) {
  const double radius = neat(0.3 * w.size), speed = w.size / w.duration, m = w.mass * own.between(0.5, 2.0);
  const double weight = m * std::max(w.gravity, speed * speed / w.size), along = speed * own.between(-3.0, 3.0);
  const double slip = weight * own.decades(0.3, 1.3), relaxation = radius * own.between(0.3, 1.5),
               depth = radius * own.between(0.005, 0.03);
  const double turning = own.between(-0.5, 2.0), high = own.between(0.99, 1.5); // each compiler has its own order of arguments
  const std::string body = w.body(m, 0.5 * m * radius * radius, {-20.0 * w.size, radius * high},
                                  {{"velocity", pair(along, 0.0)}, {"angular_velocity", number(-along / radius * turning)}});
  SceneWriter::Fields fields{{"a", quoted(body)},
                             {"radius", number(radius)},
                             {"stiffness", number(weight / depth)},
                             {"friction", number(own.between(0.1, 1.2))},
                             {"slip_stiffness", number(slip)},
                             {"relaxation_length", number(relaxation)},
                             {"tread_damping", number(0.2 * std::sqrt(slip / relaxation * m))}};
  if (own.chance(0.7)) fields.push_back({"damping", number(0.2 * std::sqrt(weight / depth * m))});
  if (own.chance(0.5)) {
    std::string road = "[" + pair(neat(-30.0 * w.size), 0.0);
    for (int i = -25; i < -14; ++i) road += ", " + pair(neat(i * w.size), neat(0.05 * w.size * own.between(-1.0, 1.0)));
    fields.push_back({"road", road + "]"});
  }
  const std::string tyre = w.element("tyre", fields, {body});
  if (own.chance(0.5))
    w.element("rolling_resistance", {{"contacts", "[" + quoted(tyre) + "]"}, {"arm", number(radius * own.between(0.005, 0.05))}},
              {body, tyre});
}

// A body on a skate that a spring holds, or that slides sideways where its grip ends.
void skate(SceneWriter& w, RandomNumber& own) {
  const double speed = w.size / w.duration, m = w.mass * own.between(0.5, 2.0), heading = own.between(-3.0, 3.0),
               along = speed * own.between(0.5, 2.0);
  const At place{-40.0 * w.size, 0.0};
  const std::string body = w.body(m, w.inertia_of(m, w.size), place,
                                  {{"angle", number(heading)},
                                   {"velocity", pair(along * std::cos(heading), along * std::sin(heading))},
                                   {"angular_velocity", number(own.between(-3.0, 3.0) / w.duration)}});
  SceneWriter::Fields fields{{"a", quoted(body)}};
  if (own.chance(0.5)) {
    const double grip = m * (w.gravity + speed / w.duration) * own.decades(-0.7, 0.3);
    fields.push_back({"grip", number(grip)});
    if (own.chance(0.5)) fields.push_back({"drags", number(grip * own.between(0.3, 0.95))});
  }
  w.element("skate", fields, {body});
  const double k = w.stiffness_for(m, 0.3, 3.0);
  w.element("spring_damper",
            {{"a", quoted(body)},
             {"b", marker("ground", {place.x, 2.0 * w.size})},
             {"stiffness", number(k)},
             {"damping", number(w.damping_for(m, k))}},
            {body});
}

void add_wheels(SceneWriter& w, RandomNumber own) {
  const bool is_rolling = own.chance(0.6);
  if (is_rolling) roll(w, own);
  if (!is_rolling || own.chance(0.3)) skate(w, own);
}

// A rotor that coasts in a bearing with friction, and a pad that creeps between the ground and the body `end`.
void add_bearing(SceneWriter& w, RandomNumber own, const std::string& end) {
  const At place{-20.0 * w.size, 0.0};
  const double m = w.mass * own.between(0.5, 2.0), radius = 0.5 * w.size, k = w.stiffness_for(m, 4.0, 20.0), c = w.damping_for(m, k);
  const double spin = own.between(2.0, 10.0) / w.duration;
  const std::string rotor = w.body(m, 0.5 * m * radius * radius, place, {{"angular_velocity", number(own.chance(0.5) ? spin : -spin)}});
  w.element("bearing",
            {{"a", quoted(rotor)},
             {"b", marker("ground", place)},
             {"stiffness", number(k)},
             {"damping", number(c)},
             {"radius", number(0.1 * radius)},
             {"static_friction", number(own.between(0.05, 0.3))}},
            {rotor});
  const double creeping = w.stiffness_for(w.mass, 0.5, 4.0);
  w.element("maxwell",
            {{"a", quoted(end)},
             {"b", marker("ground", {3.0 * w.size, 3.0 * w.size})},
             {"stiffness", number(creeping)},
             {"damping", number(creeping * w.duration * own.between(0.1, 2.0))}},
            {end});
}

void add_cell(SceneWriter& w, const std::vector<NamedCell>& cells, At place, std::vector<std::string>& ends) {
  const NamedCell& cell = w.r.one_of(cells);
  w.scene.cells.insert(cell.name);
  const std::vector<std::string> bodies = cell.make(w, place);
  if (!bodies.empty()) ends.push_back(bodies.front());
}

} // namespace

Scene random_scene(std::uint64_t seed) {
  SceneWriter w(seed);
  const int count = 1 + (w.r.chance(0.35) ? 1 : 0) + (w.r.chance(0.1) ? 1 : 0);
  std::vector<std::string> ends;
  for (int i = 0; i < count; ++i) {
    const At place{i * 10.0 * w.size, 0.0};
    const int family = w.r.below(3);
    add_cell(w, family == 0 ? rotating_cells() : family == 1 ? sliding_cells() : touching_cells(), place, ends);
  }
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (w.r.chance(0.5)) couple(w, ends[i - 1], ends[i]);
  if (!ends.empty()) hold(w, RandomNumber(~seed), ends.front());
  drop(w, RandomNumber(~seed * 3));
  if (seed > k_last_without_laws && !ends.empty()) add_laws(w, RandomNumber(~seed * 5), ends.front());
  if (seed > k_last_without_actions && !ends.empty()) add_actions(w, RandomNumber(~seed * 11), ends.front());
  if (seed > k_last_without_wheels && seed <= k_last_without_actions) add_wheels(w, RandomNumber(~seed * 7));
  if (seed > k_last_without_transmissions) add_transmission(w, RandomNumber(~seed * 13));
  if (seed > k_last_without_bearings && !ends.empty()) add_bearing(w, RandomNumber(~seed * 17), ends.front());
  return w.scene;
}

Scene random_friction_scene(std::uint64_t seed) {
  SceneWriter w(seed);
  std::vector<std::string> ends;
  const std::vector<NamedCell>& cells = sliding_cells();
  const std::vector<NamedCell> rails(cells.begin(), cells.begin() + 2);
  add_cell(w, rails, {}, ends);
  return w.scene;
}

} // namespace steplap::random
