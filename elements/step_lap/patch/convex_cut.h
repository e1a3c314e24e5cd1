// A polygon cut into convex parts, once, so that overlaps can be found part by part.
//
// The cuts run from vertex to vertex of the polygon, holes included: a constrained Delaunay
// triangulation whose diagonals are taken out again wherever what is left stays convex (Hertel and
// Mehlhorn, 1983: at most four times as many parts as need be). No vertex is added, so that the
// parts make up the polygon exactly.
#pragma once

#include "elements/step_lap/patch/polygon.h"

namespace steplap {

/// What lies along one side of a part.
struct PartSide {
  int edge = 0;    ///< of the polygon, counted through its rings; cuts are counted on after them
  int beyond = -1; ///< the part on the other side of a cut; -1: nothing, an edge of the polygon
};

struct Box {
  Vec2 low{0, 0}, high{0, 0};
};

struct ConvexPart {
  std::size_t first = 0, count = 0; ///< of the cut's corners
  Box box;
};

struct ConvexCut {
  Ring corners;                ///< of all parts, one part after another, each counter-clockwise
  std::vector<PartSide> sides; ///< from a corner to the next of its part
  std::vector<ConvexPart> parts;
};

/// Precondition: the polygon is as repaired() leaves it. Throws PolygonError should the exact
/// kernel refuse it.
[[nodiscard]] ConvexCut cut_into_convex(const Polygon& polygon);

/// A convex ring as the one part of itself.
[[nodiscard]] ConvexCut uncut(const Ring& ring);

[[nodiscard]] Box box_of(const Vec2* corners, std::size_t count);

} // namespace steplap
