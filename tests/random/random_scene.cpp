#include "tests/random/random_scene.h"

#include "tests/random/scene_writer.h"

#include <algorithm>

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

// On a rope that gets taut after a little way.
void hang(SceneWriter& w, const std::string& a) {
  const double k = w.stiffness_for(w.mass, 1.0, 8.0), c = w.damping_for(w.mass, k);
  w.element("rope", {{"a", quoted(a)}, {"b", marker("ground", {0.5 * w.size, 3.0 * w.size})}, {"stiffness", number(k)},
                     {"damping", number(c)}, {"slack", number(0.02 * w.size)}}, {a});
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
  // Drawn last, and in few scenes: the others stay what they were.
  if (seed % 100 == 77 && !ends.empty()) hang(w, ends.front());
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
