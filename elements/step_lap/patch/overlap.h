// The friction area of one interface: the intersection of a sheet fixed in body a and a sheet
// fixed in body b at their present relative pose (Fig. 2 of the paper).
//
// Convex pairs are clipped edge by edge in double precision, without allocating. Other sheets are
// traced along their boundaries (traced_overlap.h) and, at the few poses where what is where cannot be told,
// overlapped by their convex parts, cut once, pair by pair, the cuts taken out again (joined_cells.h); an overlap's
// polygons are those of the sheets either way. intersect_exactly() gives the same from exact arithmetic, some hundred
// times slower. Vertices are good to a few roundings of the sheets' size either way. An area below k_no_area of the
// smaller sheet's size squared is taken as none: coordinates do not resolve it.
//
// As two sheets part the area can vanish quadratically, so its zero is a poor thing to locate.
// penetration() is positive while they overlap, negative when apart, and crosses zero
// transversally: that is what "came apart" is located by.
#pragma once

#include "elements/step_lap/patch/exact_polygon.h"
#include "elements/step_lap/patch/traced_overlap.h"

namespace steplap {

inline constexpr double k_no_area = 1e-15;

/// A sheet's polygon, validated, with what every overlap needs to know about it.
struct Outline {
  Polygon polygon;
  bool convex = false; ///< a convex ring without holes
  Vec2 centre{0, 0};   ///< of a circle that contains it
  double radius = 0;   ///< of that circle [m]
  ConvexCut cut;       ///< convex parts, together the polygon; one if it is convex
  Boundary boundary;   ///< all its edges
  BoxTree tree;        ///< over them
  BoxTree parts;       ///< over the convex parts
};

/// Repairs and prepares a polygon. Throws PolygonError as repaired() does.
[[nodiscard]] Outline make_outline(Polygon polygon);

/// Storage that repeated calls reuse; one per thread.
struct OverlapWorkspace {
  Ring placed, front, back;
  CellWorkspace cells;
  TraceWorkspace trace;
  BoxTree parts;
};

/// out := a ∩ (b at b_in_a), in a's axes; empty when there is no area. Does not allocate once
/// workspace and `out` have grown.
void intersect(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace, Region& out);

/// The same for convex pairs; others in exact arithmetic, for what is done once. Throws PolygonError
/// only if the exact kernel refuses outlines that make_outline accepted.
void intersect_exactly(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace, Region& out);

/// How far the two must move to part [m]: for convex pairs the least overlap over all edge normals
/// of both (negative: a gap that one of the normals sees, at most the distance); otherwise the
/// largest over all pairs of convex parts, along a's axes, too. Continuous in the pose; its sign is
/// that of "overlaps".
[[nodiscard]] double penetration(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace);

/// penetration() at one pose, and what it leaves of it at others, for next to nothing.
struct DepthBound {
  Pose pose;
  double depth = 0; ///< [m]
  double reach = 0; ///< of both sheets' points from the origin of b's frame [m]

  /// Not more than penetration() there: it changes by no more than a point of b moves seen from a, or of a seen from b.
  [[nodiscard]] double at_least(const Pose& there) const;
};
[[nodiscard]] DepthBound depth_bound(const Outline& a, const Outline& b, const Pose& b_in_a, OverlapWorkspace& workspace);

/// The point p of b's frame in a's frame.
[[nodiscard]] Vec2 placed(const Vec2& p, const Pose& b_in_a);

} // namespace steplap
