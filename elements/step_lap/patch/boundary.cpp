#include "elements/step_lap/patch/boundary.h"

namespace steplap {

namespace {

constexpr std::size_t k_bundle = 4; // edges per leaf; testing a few is as fast as a deeper tree

} // namespace

Boundary boundary_of(const Polygon& polygon) {
  Boundary out;
  const auto add = [&](const Ring& ring) {
    const std::size_t first = out.corners.size();
    out.rings.push_back({first, ring.size()});
    out.corners.insert(out.corners.end(), ring.begin(), ring.end());
    for (std::size_t i = 0; i < ring.size(); ++i) out.next.push_back(i + 1 == ring.size() ? first : first + i + 1);
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  return out;
}

void build_edge_tree(const Boundary& boundary, const Ring& corners, BoxTree& tree) {
  tree.build(corners.size(), k_bundle, [&](std::size_t i) {
    const Vec2 &from = corners[i], &to = corners[boundary.next[i]];
    return Box{from.cwiseMin(to), from.cwiseMax(to)};
  });
}

} // namespace steplap
