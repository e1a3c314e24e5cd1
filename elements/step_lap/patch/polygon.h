// Plane polygons with holes: the outlines of sheets and of the areas where they overlap.
//
// Convention: outer rings run counter-clockwise, holes clockwise, the last vertex joins the
// first. With this orientation every area integral is a plain sum over all edges. A polygon is
// simple: no ring crosses or touches itself or another ring, holes lie inside the outer ring.
// Coordinates are metres in the axes of whichever body the polygon is fixed to.
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

/// Disjoint polygons; empty when there is no area.
using Region = std::vector<Polygon>;

/// What is wrong with a polygon that cannot be repaired without guessing; names the ring and the
/// vertices or edges by their position in the input, counted from 0.
class PolygonError : public std::invalid_argument {
public:
  using std::invalid_argument::invalid_argument;
};

/// Area of a ring [m²], positive when counter-clockwise.
[[nodiscard]] double signed_area(const Ring& ring);

/// Area [m²] with the holes taken off.
[[nodiscard]] double area(const Polygon& polygon);
[[nodiscard]] double area(const Region& region);

/// Centre of area [m]. Precondition: the area is not zero.
[[nodiscard]] Vec2 centroid(const Polygon& polygon);
[[nodiscard]] Vec2 centroid(const Region& region);

/// True when the ring turns left (or not at all) at every vertex and goes round once.
[[nodiscard]] bool is_convex(const Ring& ring);

/// The polygon in the convention above: rings of the wrong sense reversed; repeated vertices,
/// vertices within rounding of the line through their neighbours and zero-width spikes dropped.
/// Throws PolygonError for what has no unambiguous repair: a coordinate that is not finite, a ring
/// without area, a ring that crosses or touches itself or another ring, a hole outside. Messages
/// call the holes by `hole_names`, or "hole 0" and so on without.
[[nodiscard]] Polygon repaired(Polygon polygon, const std::vector<std::string>& hole_names = {});

} // namespace steplap
