// Polygons cut into triangles by exact decisions.
#pragma once

#include "elements/step_lap/patch/polygon.h"

#include <array>
#include <cstddef>
#include <vector>

namespace steplap {

/// The constrained Delaunay triangulation: triangles (counter-clockwise) that make up the polygon, as numbers of its vertices, counted
/// through the outer ring and the holes. Of four vertices on one circle either diagonal may be taken, always the same one for the same
/// polygon. The polygon has to be as repaired() leaves it; throws PolygonError if it is not and so cannot be cut.
[[nodiscard]] std::vector<std::array<std::size_t, 3>> triangulated(const Polygon& polygon);

} // namespace steplap
