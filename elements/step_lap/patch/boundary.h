// Edges of a polygon in one list, with a tree of bounding boxes, for overlaps traced along boundaries (traced_overlap.h).
#pragma once

#include "elements/step_lap/patch/convex_cut.h"

#include <algorithm>
#include <limits>

namespace steplap {

/// Corners of all rings of a polygon, one ring after another; edge i starts at corner i.
struct Boundary {
  struct Span {
    std::size_t first = 0, count = 0;
  };
  Ring corners;
  std::vector<Span> rings;
  std::vector<std::size_t> next; ///< per corner: index of the next corner of its ring
};

/// Returns the boundary of a polygon: outer ring first, then the holes.
[[nodiscard]] Boundary boundary_of(const Polygon& polygon);

/// Binary tree of bounding boxes over consecutive items. Does not allocate once its storage is large enough.
class BoxTree {
public:
  static constexpr std::size_t k_root = 1;

  /// Builds the tree over `items` items, `bundle` per leaf; box_at(i) returns the box of item i.
  template <class BoxAt> void build(std::size_t items, std::size_t bundle, BoxAt box_at) {
    items_ = items;
    bundle_ = bundle;
    for (leaves_ = 1; leaves_ * bundle < items; leaves_ *= 2) {}
    boxes_.assign(2 * leaves_, nowhere());
    for (std::size_t i = 0; i < items; ++i) widen(boxes_[leaves_ + i / bundle], box_at(i));
    for (std::size_t i = leaves_; i-- > 1;) {
      boxes_[i] = boxes_[2 * i];
      widen(boxes_[i], boxes_[2 * i + 1]);
    }
  }

  [[nodiscard]] const Box& box(std::size_t node) const { return boxes_[node]; }
  [[nodiscard]] bool is_leaf(std::size_t node) const { return node >= leaves_; }
  [[nodiscard]] std::size_t first(std::size_t leaf) const { return (leaf - leaves_) * bundle_; }
  [[nodiscard]] std::size_t end(std::size_t leaf) const { return std::min(first(leaf) + bundle_, items_); }

private:
  static Box nowhere() {
    constexpr double far = std::numeric_limits<double>::infinity();
    return {{far, far}, {-far, -far}};
  }
  static void widen(Box& box, const Box& by) {
    box.low = box.low.cwiseMin(by.low);
    box.high = box.high.cwiseMax(by.high);
  }

  std::vector<Box> boxes_;
  std::size_t items_ = 0, bundle_ = 1, leaves_ = 1;
};

/// Builds the tree over the edges of a boundary with the given corners.
void build_edge_tree(const Boundary& boundary, const Ring& corners, BoxTree& tree);

} // namespace steplap
