// Overlap of two sheets traced along their boundaries, changing from one to the other at each crossing (Weiler and Atherton, 1977).
//
// Crossings are found by trees of boxes over the edges, at a cost proportional to edges plus crossings. The side of a line on which a
// corner lies, and the order of crossings along an edge, must be certain by many times the rounding error. If corners and edges coincide up
// to rounding, a slightly perturbed pose decides (see the .cpp). In all other uncertain cases the overlap is not traced, and the robust
// method of convex cells is used (joined_cells.h).
#pragma once

#include "elements/step_lap/patch/boundary.h"
#include "elements/step_lap/patch/joined_cells.h"

namespace steplap {

/// Scratch memory, reused by repeated calls.
struct TraceWorkspace {
  /// A crossing of two edges. Index 0: first sheet; 1: second.
  struct Crossing {
    std::size_t edge[2] = {0, 0};
    double share[2] = {0, 0}; ///< position as a fraction of the edge's length, with the second sheet perturbed
    double blur[2] = {0, 0};  ///< uncertainty of this position
    Vec2 at{0, 0};
    bool first_enters = false; ///< the first boundary enters the second sheet there; the second boundary leaves the first
  };
  /// Crossings of one sheet, sorted along its boundary.
  struct Order {
    std::vector<std::size_t> start;     ///< per edge: index in `crossings` of its first crossing; one more entry at the end
    std::vector<std::size_t> crossings; ///< indices of the crossings, sorted
    std::vector<std::size_t> place;     ///< per crossing: its position in the sorted list
  };

  Ring placed;  ///< corners of the second sheet's boundary
  BoxTree tree; ///< tree over its edges
  std::vector<Crossing> crossings;
  Order orders[2];
  std::vector<char> is_done; ///< per crossing: it has been used
  std::vector<Ring> holes;
};

/// A sheet's boundary at its present position.
struct BoundaryView {
  const Boundary* boundary = nullptr;
  const Ring* corners = nullptr;
  const BoxTree* tree = nullptr;
};

/// Writes a ∩ b to `out`, which must be empty, as join_cells() does, with storage from `spare`. Returns false, with `out` unchanged, if a
/// decision is ambiguous. Coordinates are accurate to `rounding`, m.
[[nodiscard]] bool trace_overlap(const BoundaryView& a, const BoundaryView& b, double rounding, double least_area, TraceWorkspace& w,
                                 CellWorkspace& spare, Region& out);

} // namespace steplap
