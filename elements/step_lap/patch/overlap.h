// Friction area of one interface: the intersection of a sheet fixed in body a and a sheet fixed in body b at their present relative pose
// (Fig. 2 of the paper).
//
// Convex pairs are clipped edge by edge in double precision, without allocation. Other sheets are traced along their boundaries
// (traced_overlap.h); at the few poses where this is ambiguous, the overlaps of their convex parts are joined (joined_cells.h). Both
// methods give the same polygons. intersect_exactly() gives the same result by exact arithmetic, some hundred times slower. Vertices are
// accurate to a few rounding errors of the size of the sheets. An area below k_no_area of the squared size of the smaller sheet counts as
// none, because coordinates do not resolve it.
//
// When two sheets separate the area may vanish quadratically, so its zero is hard to locate. penetration() is positive while they overlap,
// negative when separate, and crosses zero transversally; it locates the separation.
#pragma once

#include "elements/step_lap/patch/exact_polygon.h"
#include "elements/step_lap/patch/traced_overlap.h"

namespace steplap {

inline constexpr double k_no_area = 1e-15;

/// A validated polygon of a sheet with data for computing overlaps.
struct Outline {
  Polygon polygon;
  bool convex = false; ///< a convex ring without holes
  Vec2 centre{0, 0};   ///< centre of a circle that contains the polygon
  double radius = 0;   ///< radius of that circle [m]
  ConvexCut cut;       ///< convex parts; a single one for a convex polygon
  Boundary boundary;   ///< all edges of the polygon
  BoxTree tree;        ///< tree over the edges
  BoxTree parts;       ///< tree over the convex parts
};

/// Repairs and prepares a polygon. Throws PolygonError as repaired() does.
[[nodiscard]] Outline make_outline(Polygon polygon);

/// Scratch memory, reused by repeated calls; one per thread.
struct OverlapWorkspace {
  Ring placed, front, back;
  CellWorkspace cells;
  TraceWorkspace trace;
  BoxTree parts;
};

/// Sets `out` to a ∩ (b at b_in_a), in a's axes; empty if there is no area. Does not allocate once the workspace and `out` are large
/// enough.
void intersect(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace, Region& out);

/// As intersect(), but non-convex pairs by exact arithmetic, for single evaluations. Throws PolygonError only if the exact kernel rejects
/// outlines that make_outline() accepted.
void intersect_exactly(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace, Region& out);

/// Returns the distance by which the two outlines must move to separate [m]. For convex pairs it is the smallest overlap over all edge
/// normals of both (negative: a gap along one of the normals, at most the distance). Otherwise it is the largest over all pairs of convex
/// parts, with a's axes as additional normals. It is continuous in the pose, and positive if and only if the sheets overlap.
[[nodiscard]] double penetration(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace);

/// Value of penetration() at one pose, from which a cheap lower bound at other poses follows.
struct DepthBound {
  Pose pose;
  double depth = 0; ///< penetration() at `pose` [m]
  double reach = 0; ///< largest distance of points of both sheets from the origin of b's frame [m]

  /// Returns a lower bound of penetration() at pose `there` [m]: the change is at most the displacement of the points of b relative to a.
  [[nodiscard]] double at_least(const Pose& there) const;
};
/// Returns the bound for poses near `b_in_a`.
[[nodiscard]] DepthBound depth_bound(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace);

/// Returns the point p of b's frame in a's frame.
[[nodiscard]] Vec2 placed(const Vec2& p, const Pose& b_in_a);

} // namespace steplap
