// Polygon questions answered with exact arithmetic, so that no coincidence of edges or vertices
// can mislead or crash them. With exact_triangulation.h the only door to CGAL, of which only the kernels and the algorithms on
// single rings are used: these are under the LGPL, while its set operations and triangulations are under the GPL, which would bind
// whoever links steplap. Slow (tens to hundreds of microseconds) and allocating.
#pragma once

#include "elements/step_lap/patch/polygon.h"

#include <array>
#include <optional>

namespace steplap {

/// Pose of body b's frame in body a's: its origin (x, y) [m] and its angle theta [rad].
struct Pose {
  double x = 0;
  double y = 0;
  double theta = 0;
};

/// First pair of edges that meet although they must not, as {ring, ring, edge, edge}; neighbouring
/// edges of one ring may share their common vertex only. Empty when all rings are simple and apart.
[[nodiscard]] std::optional<std::array<std::size_t, 4>> find_clash(const std::vector<Ring>& rings);

/// True when the point is strictly inside the ring (either sense). The ring must be simple.
[[nodiscard]] bool is_inside(const Vec2& point, const Ring& ring);

/// a ∩ (b placed at `b_in_a`), in a's axes, exact but for the rounding of sine and cosine before
/// and of the coordinates after. Both must be as repaired() leaves them. Regularised: shared edges
/// and vertices without area give nothing. Throws PolygonError should the exact kernel refuse.
[[nodiscard]] Region exact_intersection(const Polygon& a, const Polygon& b, const Pose& b_in_a);

/// What of `a` lies outside the hole (either sense), as above.
[[nodiscard]] Region exact_difference(const Polygon& a, const Ring& hole);

} // namespace steplap
