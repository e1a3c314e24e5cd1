#include "elements/step_lap/step_lap_loss.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace steplap {

namespace {

double perimeter(const Ring& ring) {
  double length = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) length += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return length;
}

bool contains(const Ring& ring, const Vec2& p) {
  bool is_inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2 &a = ring[i], &b = ring[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) is_inside = !is_inside;
  }
  return is_inside;
}

Vec2 unplaced(const Vec2& p, const Pose& b_in_a) {
  const auto [s, c] = portable::sin_cos(b_in_a.theta);
  const Vec2 d = p - Vec2(b_in_a.x, b_in_a.y);
  return {c * d.x() + s * d.y(), c * d.y() - s * d.x()};
}

} // namespace

OverlapReference::OverlapReference(const std::vector<SheetPair>& sheets, const Pose& reference) {
  OverlapWorkspace workspace;
  Region region;
  std::vector<Vec2> middle(sheets.size(), Vec2::Zero());
  std::vector<double> around(sheets.size(), 0.0);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const SheetPair& s = sheets[i];
    Overlap& o = overlaps_.emplace_back();
    o.corner = i;
    intersect_exactly(s.yoke, s.limb, reference, workspace, region);
    if (region.empty()) continue;
    o.area = area(region);
    for (const Polygon& piece : region) {
      around[i] += s.count * perimeter(piece.outer);
      o.in_part.insert(o.in_part.end(), piece.outer.begin(), piece.outer.end());
    }
    for (const Vec2& p : o.in_part) o.in_limb.push_back(unplaced(p, reference));
    o.across = s.across.value_or(placed(centroid(s.limb.polygon), reference) - centroid(s.yoke.polygon));
    if (const double length = o.across.norm(); length > 0.0) o.across /= length;
    middle[i] = centroid(region);
  }
  // Bands belong to one corner if the centroid of each lies on the other's limb sheet and yoke sheet. Limb sheets alone would not
  // distinguish the two sides of a T-joint's point.
  for (std::size_t i = 0; i < sheets.size(); ++i)
    for (std::size_t j = 0; j < i && overlaps_[i].corner == i; ++j) {
      const bool is_over = overlaps_[i].area > 0.0 && overlaps_[j].area > 0.0 &&
                           (contains(sheets[i].limb.polygon.outer, unplaced(middle[j], reference)) ||
                            contains(sheets[j].limb.polygon.outer, unplaced(middle[i], reference))) &&
                           (contains(sheets[i].yoke.polygon.outer, middle[j]) || contains(sheets[j].yoke.polygon.outer, middle[i]));
      if (is_over) overlaps_[i].corner = overlaps_[j].corner;
    }
  std::vector<std::size_t> number(sheets.size(), sheets.size());
  std::vector<double> corner_around;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    std::size_t& corner = number[overlaps_[i].corner];
    if (corner == sheets.size()) {
      corner = corner_area_.size();
      corner_area_.push_back(0.0);
      corner_around.push_back(0.0);
    }
    overlaps_[i].corner = corner;
    corner_area_[corner] += sheets[i].count * overlaps_[i].area;
    corner_around[corner] += around[i];
  }
  for (std::size_t corner = 0; corner < corner_area_.size(); ++corner)
    corner_width_.push_back(corner_around[corner] > 0.0 ? 2.0 * corner_area_[corner] / corner_around[corner] : 0.0);
}

OverlapLoss OverlapReference::loss_at(const std::vector<SheetPair>& sheets, const Pose& pose, OverlapWorkspace& workspace,
                                      Region& region) const {
  OverlapLoss loss;
  for (std::size_t corner = 0; corner < corner_area_.size(); ++corner) {
    if (!(corner_area_[corner] > 0.0)) {
      loss.overlap_left = 0.0;
      continue;
    }
    double left = 0.0;
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      const Overlap& o = overlaps_[i];
      if (o.corner != corner) continue;
      intersect(sheets[i].yoke, sheets[i].limb, pose, workspace, region);
      const double now = area(region);
      left += sheets[i].count * now;
      loss.area_lost += sheets[i].count * std::max(0.0, o.area - now);
      double closed = 0.0, moved = 0.0;
      for (std::size_t k = 0; k < o.in_limb.size(); ++k) {
        const Vec2 move = placed(o.in_limb[k], pose) - o.in_part[k];
        moved = std::max(moved, move.norm());
        closed = std::max(closed, -o.across.dot(move));
      }
      loss.slid_share = std::max(loss.slid_share, moved / corner_width_[corner]);
      if (sheets[i].clearance) loss.clearance_left = std::min(loss.clearance_left, *sheets[i].clearance - closed);
    }
    loss.overlap_left = std::min(loss.overlap_left, left / corner_area_[corner]);
  }
  return loss;
}

} // namespace steplap
