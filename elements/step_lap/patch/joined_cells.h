// The overlap of two sheets from the overlaps of their convex parts.
//
// Each pair of parts leaves a convex cell at most. A side of a cell that lies on a cut of one of the
// sheets is shared with the cell beyond the cut; two such sides are taken out together where
// their ends agree to rounding, and the sides that are left are followed from cell to cell. What
// comes out are the rings of the sheets themselves, without the cuts.
//
// Nothing hangs on every cut being taken out: a side whose partner is not found (cuts of both sheets on
// one line, a cell that is narrower than rounding) stays on both cells, and cancels in every
// integral over the area as it would have been cancelled here.
#pragma once

#include "elements/step_lap/patch/convex_clip.h"

namespace steplap {

/// Storage that repeated calls reuse.
struct CellWorkspace {
  struct Cell {
    std::size_t first = 0, count = 0; ///< corners
    std::size_t parts[2] = {0, 0};
    std::size_t root = 0; ///< a cell that it hangs together with
    int polygon = -1;
  };
  static constexpr std::size_t k_none = static_cast<std::size_t>(-1);

  ClipWorkspace clip;
  Ring placed;            ///< corners of the second sheet's parts
  std::vector<Box> boxes; ///< of those parts
  std::vector<Cell> cells;
  std::vector<std::size_t> cell_of; ///< by pair of parts; all k_none between calls
  std::vector<Corner> corners;      ///< of all cells
  std::vector<std::size_t> cell_at; ///< by corner
  std::vector<std::size_t> partner; ///< by corner: the other half of its side, or k_none
  std::vector<char> is_written;     ///< by corner
  std::vector<Polygon> polygons;    ///< spare ones
  std::vector<Ring> rings;          ///< spare ones
};

/// Appends a ∩ b, b's corners being those in w.placed, to `out`: polygons with more than
/// `least_area`, their storage taken from w's spare ones. Coordinates are good to `rounding`, and what is narrower is nothing.
void join_cells(const ConvexCut& a, const ConvexCut& b, double rounding, double least_area, CellWorkspace& w, Region& out);

/// Takes the polygons out of `out`, keeping their storage.
void empty_keeping_storage(Region& out, CellWorkspace& w);

} // namespace steplap
