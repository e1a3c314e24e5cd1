#include "transformer/core/core_windows.h"

#include "mbd/model/entries.h"
#include "transformer/core/core_builder.h"
#include "transformer/core/core_geometry.h"

#include <algorithm>

namespace steplap {

namespace {

// A limb relative to the active part's centre of gravity, in its axes, m. `low` and `high` are the bottom and top of the adjacent window.
struct Standing {
  double x, half_width, low, high;
};

std::vector<Standing> limbs_of(const Body& active_part, const Model& model) {
  std::vector<Standing> limbs;
  for (const Core* core : tables_of<Core>(model)) {
    if (core->active_part != active_part.name) continue;
    const CoreGeometry geometry(*core);
    for (const std::string& name : core->all_limbs()) {
      const Mitre mitre = geometry.mitre(geometry.largest(), false);
      const Vec2 middle = middle_of_limb(*core, *model.find_body(name), active_part);
      const double half = 0.5 * mitre.core_height - mitre.yoke_height;
      limbs.push_back({middle.x(), 0.5 * mitre.limb_width, middle.y() - half, middle.y() + half});
    }
  }
  std::sort(limbs.begin(), limbs.end(), [](const Standing& a, const Standing& b) { return a.x < b.x; });
  return limbs;
}

// Returns true if p is inside the polygon: ray crossing test by W. R. Franklin.
bool is_inside(const Vec2& p, const std::vector<Vec2>& ring) {
  bool is = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    if ((ring[i].y() > p.y()) != (ring[j].y() > p.y()) &&
        p.x() < ring[i].x() + (ring[j].x() - ring[i].x()) * (p.y() - ring[i].y()) / (ring[j].y() - ring[i].y()))
      is = !is;
  return is;
}

} // namespace

std::vector<std::vector<Vec2>> core_windows(const Body& active_part, const Model& model) {
  std::vector<std::vector<Vec2>> windows;
  const std::vector<Standing> limbs = limbs_of(active_part, model);
  for (std::size_t i = 0; i + 1 < limbs.size(); ++i) {
    const Standing &a = limbs[i], &b = limbs[i + 1];
    const Vec2 low(a.x + a.half_width, std::max(a.low, b.low)), high(b.x - b.half_width, std::min(a.high, b.high));
    if (!(high.x() > low.x()) || !(high.y() > low.y())) continue;
    const std::vector<Vec2> ring{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    // The corners are moved inwards by a thousandth, because the window's edge may coincide with the outline.
    const Vec2 middle = 0.5 * (low + high);
    const bool is_covered = std::all_of(ring.begin(), ring.end(), [&](const Vec2& p) {
      return is_inside(middle + 0.999 * (p - middle) + active_part.cg, active_part.outline);
    });
    if (is_covered) windows.push_back(ring);
  }
  return windows;
}

} // namespace steplap
