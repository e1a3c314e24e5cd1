#include "tests/random/random_scene.h"

#include "tests/random/scene_writer.h"

#include <algorithm>
#include <cmath>

namespace steplap::random {

namespace {

// From the bodies of one mechanism to those of another.
void couple(SceneWriter& w, const std::string& a, const std::string& b) {
  const double k = w.stiffness_for(w.mass, 0.5, 8.0), c = w.damping_for(w.mass, k);
  if (w.r.chance(0.7))
    w.element("spring_damper", {{"a", quoted(a)}, {"b", quoted(b)}, {"stiffness", number(k)}, {"damping", number(c)}}, {a, b});
  else
    w.element("bushing", {{"a", quoted(a)}, {"b", quoted(b)}, {"stiffness", pair(k, k)}, {"damping", pair(c, c)}}, {a, b});
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
  const std::string body = w.body(m, 0.4 * m * radius * radius, {-10.0 * w.size, height},
                                  {{"outline", outline + "]"}, {"velocity", pair(along, 0.0)}});
  const double weight = m * std::max(w.gravity, speed * speed / w.size);
  SceneWriter::Fields fields{{"a", quoted(body)}, {"stiffness", number(weight / (k_depth * w.size * w.size))}};
  if (own.chance(0.7)) fields.push_back({"static_friction", number(own.between(0.05, 0.8))});
  if (own.chance(0.5)) fields.push_back({"dissipation", number(own.between(0.01, 0.2) / speed)});
  w.element("polygon_contact", fields, {body});
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
