// Overlap of two sheets from the overlaps of their convex parts.
//
// Each pair of parts gives at most one convex cell. A side of a cell on a cut of one of the sheets is shared with the cell on the other
// side. Two such sides whose ends agree up to rounding are removed, and the remaining sides are followed from cell to cell. The result has
// the rings of the sheets themselves, without the cuts.
//
// Not every cut needs to be removed: a side without partner (cuts of both sheets on one line, a cell narrower than rounding) remains on
// both cells and cancels in every integral over the area.
#pragma once

#include "elements/step_lap/patch/convex_clip.h"

namespace steplap {

/// Scratch memory, reused by repeated calls.
struct CellWorkspace {
  struct Cell {
    std::size_t first = 0, count = 0; ///< range of indices in `corners`
    std::size_t parts[2] = {0, 0};
    std::size_t root = 0; ///< representative of its connected component
    int polygon = -1;
  };
  static constexpr std::size_t k_none = static_cast<std::size_t>(-1);

  ClipWorkspace clip;
  Ring placed;            ///< corners of the second sheet's parts
  std::vector<Box> boxes; ///< bounding boxes of these parts
  std::vector<Cell> cells;
  std::vector<std::size_t> cell_of; ///< per pair of parts: index of its cell; k_none between calls
  std::vector<Corner> corners;      ///< corners of all cells
  std::vector<std::size_t> cell_at; ///< per corner: its cell
  std::vector<std::size_t> partner; ///< per corner: the other copy of its side, or k_none
  std::vector<char> is_written;     ///< per corner: its side has been written
  std::vector<Polygon> polygons;    ///< unused polygons
  std::vector<Ring> rings;          ///< unused rings
};

/// Appends a ∩ b to `out`, as polygons with an area above `least_area`, with storage from w. w.placed: corners of b. Coordinates are
/// accurate to `rounding`, m; narrower parts are dropped.
void join_cells(const ConvexCut& a, const ConvexCut& b, double rounding, double least_area, CellWorkspace& w, Region& out);

/// Removes the polygons from `out` and keeps their storage.
void empty_keeping_storage(Region& out, CellWorkspace& w);

} // namespace steplap
