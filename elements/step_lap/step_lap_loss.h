// What sliding has done to the overlaps of a step-lap joint, against those of its reference pose.
//
// Interfaces whose sheets lie over each other (the bands of a book at one corner of a core, or one side of a
// T-joint's point) make up a *corner*. A corner's displacement is the largest of its overlaps' vertices, fixed
// in the limb and seen from the active part; the width of a strip b × l is taken as 2 area/perimeter,
// b l/(b + l), which is b but for b/l, that of a corner as 2 Σ area/Σ perimeter over all its interfaces. *Across*
// an overlap is as the interface says, else from the middle of the yoke sheet to that of the limb sheet: the limb
// closes its clearance by moving against it.
#pragma once

#include "elements/step_lap/step_lap_interface.h"

#include <limits>

namespace steplap {

struct OverlapLoss {
  double area_lost = 0.0;    ///< m², of the interfaces that lost some, each times its number
  double overlap_left = 1.0; ///< share that is left to the corner that has lost most; 0: wholly parted, or without overlap from the start
  double slid_share = 0.0;   ///< largest displacement of a corner, of the width of its overlap
  double clearance_left = std::numeric_limits<double>::infinity(); ///< m, the least; of interfaces that state theirs
};

class OverlapReference {
public:
  OverlapReference() = default;
  OverlapReference(const std::vector<SheetPair>& sheets, const Pose& reference);

  [[nodiscard]] OverlapLoss loss_at(const std::vector<SheetPair>& sheets, const Pose& pose, OverlapWorkspace& workspace,
                                    Region& region) const;
  [[nodiscard]] std::size_t corner_count() const { return corner_area_.size(); }
  [[nodiscard]] std::size_t corner_of(std::size_t sheets) const { return overlaps_[sheets].corner; }
  [[nodiscard]] double area_of(std::size_t sheets) const { return overlaps_[sheets].area; } ///< m², of one interface
  /// Of its overlap, in the active part's axes.
  [[nodiscard]] const std::vector<Vec2>& vertices_of(std::size_t sheets) const { return overlaps_[sheets].in_part; }

private:
  struct Overlap {
    double area = 0.0;
    Vec2 across = Vec2::Zero();         ///< active part's axes, length 1
    std::vector<Vec2> in_part, in_limb; ///< vertices of the overlap, in either body's axes
    std::size_t corner = 0;
  };
  std::vector<Overlap> overlaps_;    ///< as the sheets
  std::vector<double> corner_area_;  ///< m², with the numbers of interfaces
  std::vector<double> corner_width_; ///< m
};

} // namespace steplap
