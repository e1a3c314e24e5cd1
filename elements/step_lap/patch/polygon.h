// Plane polygons with holes: outlines of sheets and of their overlaps.
//
// Outer rings run counter-clockwise, holes clockwise; the last vertex is connected to the first. Every area integral is then a plain sum
// over all edges. A polygon is simple: no ring crosses or touches itself or another ring, holes are inside the outer ring. Coordinates are
// in metres, in the axes of the body to which the polygon is fixed.
#pragma once

#include "mbd/base/types.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace steplap {

using Ring = std::vector<Vec2>;

/// One connected area: an outer ring (counter-clockwise) and holes (clockwise).
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// Disjoint polygons; empty if there is no area.
using Region = std::vector<Polygon>;

/// Error in a polygon that cannot be repaired unambiguously. The message names the ring and the vertices or edges by their index in the
/// input, from 0.
class PolygonError : public std::invalid_argument {
public:
  using std::invalid_argument::invalid_argument;
};

/// Returns the area of a ring [m²], positive if counter-clockwise.
[[nodiscard]] double signed_area(const Ring& ring);

/// Returns the area without the holes [m²].
[[nodiscard]] double area(const Polygon& polygon);
[[nodiscard]] double area(const Region& region);

/// Returns the centroid [m]. Precondition: the area is not zero.
[[nodiscard]] Vec2 centroid(const Polygon& polygon);
[[nodiscard]] Vec2 centroid(const Region& region);

/// Returns true if the ring turns left (or not at all) at every vertex and winds around once.
[[nodiscard]] bool is_convex(const Ring& ring);

/// Returns the polygon in the convention above: rings are reversed if necessary; repeated vertices, vertices collinear with their
/// neighbours up to rounding, and zero-width spikes are removed. Throws PolygonError for defects that cannot be repaired unambiguously: a
/// coordinate that is not finite, a ring without area, a ring that crosses or touches itself or another ring, a hole outside. Messages use
/// the names `hole_names`, by default "hole 0" and so on.
[[nodiscard]] Polygon repaired(Polygon polygon, const std::vector<std::string>& hole_names = {});

} // namespace steplap
