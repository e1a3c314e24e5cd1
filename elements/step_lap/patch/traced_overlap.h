// The overlap of two sheets traced along their boundaries: from crossing to crossing, changing from the
// one to the other, as drawn by hand (Weiler and Atherton, 1977).
//
// The crossings are found by trees of boxes over the edges, so that the cost goes with edges plus crossings.
// Which side of a line a corner is on, and in which order an edge is crossed, has to be clear by many roundings. Where
// corners and edges lie on each other to a few roundings, the sides are those of a pose beside it (see the .cpp).
// What is neither clear nor on each other is not traced: the cells of convex parts take over (joined_cells.h),
// which nothing can mislead.
#pragma once

#include "elements/step_lap/patch/boundary.h"
#include "elements/step_lap/patch/joined_cells.h"

namespace steplap {

/// Storage that repeated calls reuse.
struct TraceWorkspace {
  /// Two edges and where they cross. Index 0: the first sheet; 1: the second.
  struct Crossing {
    std::size_t edge[2] = {0, 0};
    double share[2] = {0, 0}; ///< of the edge's length before it, the second sheet pushed
    double blur[2] = {0, 0};  ///< by which that is not known
    Vec2 at{0, 0};
    bool first_enters = false; ///< the first boundary goes in at it: the second goes out
  };
  /// The crossings of one sheet, in their order along its boundary.
  struct Order {
    std::vector<std::size_t> start;     ///< by edge: its first one in `crossings`; one more at the end
    std::vector<std::size_t> crossings; ///< sorted
    std::vector<std::size_t> place;     ///< of a crossing in `crossings`
  };

  Ring placed;  ///< corners of the second sheet's boundary
  BoxTree tree; ///< over its edges
  std::vector<Crossing> crossings;
  Order orders[2];
  std::vector<char> is_done; ///< by crossing
  std::vector<Ring> holes;
};

/// A sheet's boundary where it is now.
struct BoundaryView {
  const Boundary* boundary = nullptr;
  const Ring* corners = nullptr;
  const BoxTree* tree = nullptr;
};

/// Puts a ∩ b into `out`, which must be empty, as join_cells() does, its storage taken from `spare`. False, and nothing
/// is put there, where a question was too close to call. Coordinates are good to `rounding`.
[[nodiscard]] bool trace_overlap(const BoundaryView& a, const BoundaryView& b, double rounding, double least_area, TraceWorkspace& w,
                                 CellWorkspace& spare, Region& out);

} // namespace steplap
