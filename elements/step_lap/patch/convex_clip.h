// Clipping of one convex ring by another, with the origin of each edge, and the largest gap between two rings.
//
// Rings with few corners are clipped edge by edge. For many corners, consecutive edges of one ring cut the other at positions that follow
// each other around it; following them takes n + m steps instead of n·m. Both methods compute the corners of a cut by the same arithmetic.
#pragma once

#include "elements/step_lap/patch/convex_cut.h"

#include <limits>

namespace steplap {

/// A corner and the side that starts there, with the sheet to which the side belongs.
struct Corner {
  Vec2 at{0, 0};
  PartSide side;
  bool is_second = false;
};

/// From this product of the numbers of corners on, two rings are clipped by following the cuts.
inline constexpr std::size_t k_many_corners = 400;

/// Scratch memory, reused by repeated calls.
struct ClipWorkspace {
  struct Link {
    Corner corner;
    std::size_t next = 0, prev = 0;
  };
  std::vector<Corner> ring, spare;
  std::vector<double> beyond;
  std::vector<Link> links;
};

/// A convex ring: corners and, if not null, the sides that start there.
struct RingView {
  const Vec2* corners = nullptr;
  const PartSide* sides = nullptr;
  std::size_t count = 0;
};

/// Sets w.ring to a ∩ b, without sides of zero length; a result with fewer than three corners has no area.
void clip(const RingView& a, const RingView& b, ClipWorkspace& w);

/// Returns the largest signed distance, over the edges of `ring`, of the nearest corner of `other` (positive outwards), m. A positive value
/// means that the edge separates the rings. The search stops when `enough` is reached.
[[nodiscard]] double widest_gap(const RingView& ring, const RingView& other, double enough = std::numeric_limits<double>::infinity());

} // namespace steplap
