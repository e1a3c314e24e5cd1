// Division of a polygon into convex parts, made once, so that overlaps can be computed part by part.
//
// Cuts connect vertices of the polygon, including holes: a constrained Delaunay triangulation, from which diagonals are removed as long as
// the parts remain convex (Hertel and Mehlhorn, 1983; at most four times the minimal number of parts). No vertices are added, so the parts
// make up the polygon exactly.
#pragma once

#include "elements/step_lap/patch/polygon.h"

namespace steplap {

/// Origin of one side of a part.
struct PartSide {
  int edge = 0;    ///< edge of the polygon, counted over its rings; cuts have higher numbers
  int beyond = -1; ///< part on the other side of a cut; −1: an edge of the polygon
};

/// Bounding box parallel to the axes.
struct Box {
  Vec2 low{0, 0}, high{0, 0};
};

/// One convex part of a polygon.
struct ConvexPart {
  std::size_t first = 0, count = 0; ///< range of indices in ConvexCut::corners
  Box box;
};

/// Division of a polygon into convex parts.
struct ConvexCut {
  Ring corners;                ///< corners of all parts, one part after another, each counter-clockwise
  std::vector<PartSide> sides; ///< side from each corner to the next of its part
  std::vector<ConvexPart> parts;
};

/// Returns the convex parts. Precondition: the polygon comes from repaired(). Throws PolygonError if the exact kernel rejects it.
[[nodiscard]] ConvexCut cut_into_convex(const Polygon& polygon);

/// Returns a convex ring as a division into a single part.
[[nodiscard]] ConvexCut uncut(const Ring& ring);

/// Returns the bounding box of `count` points.
[[nodiscard]] Box box_of(const Vec2* corners, std::size_t count);

} // namespace steplap
