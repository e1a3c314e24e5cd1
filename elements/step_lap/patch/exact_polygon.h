// Geometric predicates and operations on polygons in exact arithmetic, which coincident edges or vertices cannot mislead. Slow (tens to
// hundreds of microseconds), and allocating.
//
// Together with exact_triangulation.h this is the only use of CGAL. Only its kernels and algorithms on single rings are used, which are
// under the LGPL; its set operations and triangulations are under the GPL, which would apply to all programs linked with steplap.
#pragma once

#include "elements/step_lap/patch/polygon.h"

#include <array>
#include <optional>

namespace steplap {

/// Pose of body b's frame in body a's: origin (x, y) [m] and angle theta [rad].
struct Pose {
  double x = 0;
  double y = 0;
  double theta = 0;
};

/// Returns the first pair of edges that intersect although they must not, as {ring, ring, edge, edge}; nothing if all rings are simple and
/// separate. Neighbouring edges of a ring may share only their common vertex.
[[nodiscard]] std::optional<std::array<std::size_t, 4>> find_clash(const std::vector<Ring>& rings);

/// Returns true if the point is strictly inside the ring (in either order of corners). Precondition: the ring is simple.
[[nodiscard]] bool is_inside(const Vec2& point, const Ring& ring);

/// Returns a ∩ (b placed at `b_in_a`), in a's axes, exact except for the rounding of sine and cosine before and of the coordinates after.
/// Precondition: both polygons come from repaired(). Common edges and vertices without area give nothing (regularised). Throws PolygonError
/// if the exact kernel rejects the polygons.
[[nodiscard]] Region exact_intersection(const Polygon& a, const Polygon& b, const Pose& b_in_a);

/// Returns the part of `a` outside the hole (in either order of corners), with the conditions of exact_intersection().
[[nodiscard]] Region exact_difference(const Polygon& a, const Ring& hole);

} // namespace steplap
