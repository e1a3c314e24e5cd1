// A corner of a core: the mitre between a limb and a yoke, and the outlines of the two sheets there.
//
// Axes are those of the active part, with the origin in the middle of the limb, on its axis at half the height of the core. `side` is +1
// for a limb in front of the active part, −1 behind it; `level` is +1 at the top, −1 at the bottom. The mitre runs from the corner of the
// window, (−side·W/2, level·(H/2 − Y)), outwards along t = (side cos α, level sin α); n = (side sin α, −level cos α) points away from the
// yoke. W is the limb width, H the height of the core, Y the height of a yoke, α the angle of the mitre relative to the yoke: from corner
// to corner of the rectangle common to limb and yoke (tan α = Y/W), or given.
//
// Sheets are cut along a line parallel to the mitre, at q across it. The limb sheet is the part of the limb strip (|x| < W/2) beyond q, the
// yoke sheet the part of the yoke strip before q; both end flush with limb and yoke. A middle limb ends in a point in a notch of the yoke
// (T-joint): two such cuts, `side` +1 and −1, each from a corner of the window to the limb's axis. The yoke sheet is then given in two
// halves, divided at that axis, so that all outlines are convex. The idealisation of the paper uses strips along the mitre with square
// ends, `band`.
#pragma once

#include "mbd/base/types.h"

#include <optional>
#include <vector>

namespace steplap {

/// Dimensions of limb and yoke at a corner.
struct Mitre {
  double limb_width = 0.0, core_height = 0.0, yoke_height = 0.0; ///< dimensions, m
  std::optional<double> angle; ///< angle of the mitre relative to the yoke, rad; not given: from corner to corner
};

/// Position and directions of one mitre, in axes with the origin in the middle of the limb, m.
struct CornerFrame {
  Vec2 origin = Vec2::Zero(); ///< corner of the window
  Vec2 along = Vec2::Zero();  ///< unit vector t along the mitre, outwards
  Vec2 across = Vec2::Zero(); ///< unit vector n across the mitre, away from the yoke
  double length = 0.0;        ///< length of the mitre, m
};

/// Returns the frame of the mitre at an outer limb.
[[nodiscard]] CornerFrame corner_frame(const Mitre& mitre, double side, double level);

/// Returns the frame of one side of a middle limb's point: the mitre that rises towards `side`. Precondition: mitre.angle is given.
[[nodiscard]] CornerFrame notch_frame(const Mitre& mitre, double side, double level);

/// Returns the four corners of the rectangle s₀…s₁ along × q₀…q₁ across the mitre.
[[nodiscard]] std::vector<Vec2> band(const CornerFrame& frame, double s0, double s1, double q0, double q1);

/// Return the part of a convex ring beyond the line at q (parallel to the mitre), or the part before it.
[[nodiscard]] std::vector<Vec2> beyond(const std::vector<Vec2>& ring, const CornerFrame& frame, double q);
[[nodiscard]] std::vector<Vec2> before(const std::vector<Vec2>& ring, const CornerFrame& frame, double q);

/// Returns the end of a limb, from half its height on, cut at q; empty if nothing is left.
[[nodiscard]] std::vector<Vec2> limb_end(const Mitre& mitre, double side, double level, double q);
/// Returns the end of a middle limb, which ends in a point, cut at q; empty if nothing is left.
[[nodiscard]] std::vector<Vec2> pointed_end(const Mitre& mitre, double level, double q);
/// Returns the whole limb with both ends cut at q.
[[nodiscard]] std::vector<Vec2> whole_limb(const Mitre& mitre, double side, double q);
/// Returns the whole middle limb with both ends cut at q.
[[nodiscard]] std::vector<Vec2> whole_pointed_limb(const Mitre& mitre, double q);

/// Returns the end of the yoke at an outer limb, up to `reach` from the limb's axis towards the active part.
[[nodiscard]] std::vector<Vec2> yoke_end(const Mitre& mitre, double side, double level, double q, double reach);
/// Returns the half of a notched yoke on this side of a middle limb's axis.
[[nodiscard]] std::vector<Vec2> yoke_half(const Mitre& mitre, double side, double level, double q, double reach);

/// Returns the upper limit of |q| for cuts, m: on either side of the mitre, a parallel line at a smaller distance crosses the rectangle
/// common to limb and yoke.
[[nodiscard]] double cut_distance_limit(const Mitre& mitre);

} // namespace steplap
