// A corner of a core: where a limb and a yoke meet at a mitre, and the outlines of the two sheets there.
//
// Axes: those of the active part, origin at the limb's centre; `side` +1 for a limb ahead of the active
// part, −1 behind it, `level` +1 top, −1 bottom. The mitre runs from the corner of the window,
// (−side·W/2, level·(H/2 − Y)), outwards along t = (side cos α, level sin α); n = (side sin α,
// −level cos α) points away from the yoke. W limb width, H height of the core, Y height of a yoke, α
// angle of the mitre against the yoke. From corner to corner of the rectangle where limb and yoke cross
// (tan α = Y/W), or else as far as limb and yoke both reach.
//
// A middle limb ends in a point that enters a notch of the yoke (T-joint): two such mitres, `side` +1 and −1,
// each from a corner of the window to the limb's centre line.
#pragma once

#include "mbd/base/types.h"

#include <optional>
#include <vector>

namespace steplap {

struct Mitre {
  double limb_width = 0.0, core_height = 0.0, yoke_height = 0.0; ///< m
  std::optional<double> angle; ///< rad against the yoke; none: from corner to corner
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

} // namespace steplap
