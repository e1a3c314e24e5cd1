// Clipping one convex ring by another whose edges remember where they come from, and the widest gap
// between two, for rings of few corners and of many.
//
// Few corners are cut edge by edge. With many, consecutive edges of the one cut the other at places
// that follow each other round it: the place is followed instead of looked for, and n + m steps do
// for n·m. Both find a cut's corners by the same arithmetic.
#pragma once

#include "elements/step_lap/patch/convex_cut.h"

#include <limits>

namespace steplap {

/// A corner and the side that starts there: of the first of two sheets, or of the second.
struct Corner {
  Vec2 at{0, 0};
  PartSide side;
  bool is_second = false;
};

/// From this product of their corners on, two rings are treated as having many.
inline constexpr std::size_t k_many_corners = 400;

/// Storage that repeated calls reuse.
struct ClipWorkspace {
  struct Link {
    Corner corner;
    std::size_t next = 0, prev = 0;
  };
  std::vector<Corner> ring, spare;
  std::vector<double> beyond;
  std::vector<Link> links;
};

/// A convex ring: its corners and, unless null, the sides that start at them.
struct RingView {
  const Vec2* corners = nullptr;
  const PartSide* sides = nullptr;
  std::size_t count = 0;
};

/// w.ring := a ∩ b without sides of length zero; empty or fewer than three corners: no area.
void clip(const RingView& a, const RingView& b, ClipWorkspace& w);

/// Greatest signed distance of the nearest corner of `other` from an edge of `ring`, outwards
/// positive: positive means that the edge separates them. Not looked for further once it is `enough`.
[[nodiscard]] double widest_gap(const RingView& ring, const RingView& other, double enough = std::numeric_limits<double>::infinity());

} // namespace steplap
