// Triangulation of polygons by exact predicates.
#pragma once

#include "elements/step_lap/patch/polygon.h"

#include <array>
#include <cstddef>
#include <vector>

namespace steplap {

/// Returns the constrained Delaunay triangulation as vertex indices of counter-clockwise triangles; vertices are counted over the outer
/// ring, then the holes. If four vertices are on one circle, the choice of the diagonal is arbitrary but always the same for the same
/// polygon. Precondition: the polygon comes from repaired(). Throws PolygonError if it cannot be triangulated.
[[nodiscard]] std::vector<std::array<std::size_t, 3>> triangulated(const Polygon& polygon);

} // namespace steplap
