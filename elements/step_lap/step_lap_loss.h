// Loss of overlap of a step-lap joint by sliding, compared with its reference pose.
//
// Interfaces whose sheets are stacked (the bands of a book at one corner of a core, or one side of a T-joint's point) form a corner. The
// displacement of a corner is the largest displacement of the vertices of its overlaps, fixed in the limb, relative to the active part. The
// width of a strip b × l is taken as 2 area/perimeter = b l/(b + l), nearly b; that of a corner as 2 Σ area/Σ perimeter over its
// interfaces. The direction across an overlap is given by the interface; otherwise it leads from the centroid of the yoke sheet to that of
// the limb sheet. The limb closes its clearance by moving in the opposite direction.
#pragma once

#include "elements/step_lap/step_lap_interface.h"

#include <limits>

namespace steplap {

/// Loss of overlap of one joint relative to the reference pose.
struct OverlapLoss {
  double area_lost = 0.0; ///< lost area, m²: sum over the interfaces that lost area, times their numbers
  /// Remaining fraction of the overlap, for the corner that lost most; 0: separated completely, or no overlap from the start.
  double overlap_left = 1.0;
  double slid_share = 0.0; ///< largest displacement of a corner relative to the width of its overlap
  double clearance_left = std::numeric_limits<double>::infinity(); ///< smallest remaining clearance, m, over the interfaces that have one
};

/// Overlaps in the reference pose.
class OverlapReference {
public:
  OverlapReference() = default;
  /// Computes the overlaps of the sheets at the pose `reference`.
  OverlapReference(const std::vector<SheetPair>& sheets, const Pose& reference);

  /// Returns the loss at `pose`. `workspace` and `region` are scratch memory.
  [[nodiscard]] OverlapLoss loss_at(const std::vector<SheetPair>& sheets, const Pose& pose, OverlapWorkspace& workspace,
                                    Region& region) const;
  [[nodiscard]] std::size_t corner_count() const { return corner_area_.size(); }
  /// Returns the corner to which interface `sheets` belongs.
  [[nodiscard]] std::size_t corner_of(std::size_t sheets) const { return overlaps_[sheets].corner; }
  [[nodiscard]] double area_of(std::size_t sheets) const { return overlaps_[sheets].area; } ///< area of one interface, m²
  /// Returns the vertices of the overlap of one interface, in the axes of the active part, m.
  [[nodiscard]] const std::vector<Vec2>& vertices_of(std::size_t sheets) const { return overlaps_[sheets].in_part; }

private:
  struct Overlap {
    double area = 0.0;
    Vec2 across = Vec2::Zero();         ///< direction across the overlap, unit vector, axes of the active part
    std::vector<Vec2> in_part, in_limb; ///< vertices of the overlap in the axes of either body
    std::size_t corner = 0;
  };
  std::vector<Overlap> overlaps_;    ///< per pair of sheets
  std::vector<double> corner_area_;  ///< per corner: overlap area, m², including the numbers of interfaces
  std::vector<double> corner_width_; ///< per corner: width, m
};

} // namespace steplap
