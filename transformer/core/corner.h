// A corner of a core: where a limb and a yoke meet at a mitre, and the outlines of the two sheets there.
//
// Axes: those of the active part, origin in the middle of the limb, on its axis at half the core's height;
// `side` +1 for a limb ahead of the active part, −1 behind it, `level` +1 top, −1 bottom. The mitre runs from
// the corner of the window, (−side·W/2, level·(H/2 − Y)), outwards along t = (side cos α, level sin α);
// n = (side sin α, −level cos α) points away from the yoke. W limb width, H height of the core, Y height of a
// yoke, α angle of the mitre against the yoke: from corner to corner of the rectangle where limb and yoke cross
// (tan α = Y/W), or given.
//
// Sheets are cut along a line parallel to the mitre, at q across it: the limb's sheet is what the limb's strip
// (|x| < W/2) has beyond q, the yoke's what the yoke's strip has before it, both cut off flush where limb and
// yoke end. A middle limb ends in a point that enters a notch of the yoke (T-joint): two such cuts, `side` +1
// and −1, each from a corner of the window to the limb's axis; the yoke's sheet is given in two halves, parted
// along that axis, so that all outlines are convex.
//
// The paper's own idealisation are strips along the mitre with square ends, `band`.
#pragma once

#include "mbd/base/types.h"

#include <optional>
#include <vector>

namespace steplap {

struct Mitre {
  double limb_width = 0.0, core_height = 0.0, yoke_height = 0.0; ///< m
  std::optional<double> angle;                                   ///< rad against the yoke; none: from corner to corner
};

struct CornerFrame {
  Vec2 origin = Vec2::Zero(); ///< corner of the window
  Vec2 along = Vec2::Zero();  ///< t
  Vec2 across = Vec2::Zero(); ///< n, away from the yoke
  double length = 0.0;        ///< of the mitre, m
};

[[nodiscard]] CornerFrame corner_frame(const Mitre& mitre, double side, double level);

/// One side of a middle limb's point: the mitre that rises towards `side`. Needs mitre.angle.
[[nodiscard]] CornerFrame notch_frame(const Mitre& mitre, double side, double level);

/// The points s₀…s₁ along × q₀…q₁ across: four corners.
[[nodiscard]] std::vector<Vec2> band(const CornerFrame& frame, double s0, double s1, double q0, double q1);

/// What the ring, convex, has on the far side of the line at q across the mitre, or before it.
[[nodiscard]] std::vector<Vec2> beyond(const std::vector<Vec2>& ring, const CornerFrame& frame, double q);
[[nodiscard]] std::vector<Vec2> before(const std::vector<Vec2>& ring, const CornerFrame& frame, double q);

/// The end of a limb at a level, from half its height on, cut at q; empty if nothing is left.
[[nodiscard]] std::vector<Vec2> limb_end(const Mitre& mitre, double side, double level, double q);
[[nodiscard]] std::vector<Vec2> pointed_end(const Mitre& mitre, double level, double q);
/// The whole limb, both ends cut at q.
[[nodiscard]] std::vector<Vec2> whole_limb(const Mitre& mitre, double side, double q);
[[nodiscard]] std::vector<Vec2> whole_pointed_limb(const Mitre& mitre, double q);

/// The yoke's end at an outer limb, as far as `reach` from the limb's axis towards the active part.
[[nodiscard]] std::vector<Vec2> yoke_end(const Mitre& mitre, double side, double level, double q, double reach);
/// The half of a notched yoke that lies towards `side` of a middle limb's axis.
[[nodiscard]] std::vector<Vec2> yoke_half(const Mitre& mitre, double side, double level, double q, double reach);

/// How far the line at q may lie from the mitre before it leaves the rectangle where limb and yoke cross.
[[nodiscard]] double least_shift(const Mitre& mitre);

} // namespace steplap
