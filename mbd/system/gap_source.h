// How near bodies are to touching, and how much of that a small motion can use up: what lets a search move bodies by finite
// steps without passing through a thin part.
//
// A gap is a lower bound of the distance of what touches, negative while it presses. Points of the touching parts lie within
// `reach_a` and `reach_b` of the bodies' centres of gravity. So a relative displacement d of these and turns φ_a, φ_b lessen the
// gap by at most |d| + |φ_a| reach_a + |φ_b| reach_b.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace steplap {

struct GapBounds {
  int a = k_ground, b = k_ground;
  double gap = 0.0;                    ///< m
  Pair<double> normal;                 ///< ground axes, of the force that would press on a: its side
  double reach_a = 0.0, reach_b = 0.0; ///< m
  /// m: pressed so deep one part is through the other, and the force pushes out on the far side. Infinite where it never does.
  double through = std::numeric_limits<double>::infinity();
};

/// A group of contacts that knows its gaps.
class GapSource {
public:
  virtual ~GapSource() = default;
  /// Appends those of all its contacts with bodies at `motion`, in whatever modes they are.
  virtual void add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const = 0;
};

/// Of a point of a over a line of b, closed where `measure` is below `offset`. The line has no far side.
inline GapBounds gap_bounds(const AxisMeasure& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  const auto m = measure.at<false, double>(a, b);
  GapBounds bounds;
  bounds.gap = m.value - offset;
  bounds.normal = m.direction;
  bounds.reach_a = measure.point_a.norm();
  // The point may come as much further from b's centre as it comes nearer to the line.
  bounds.reach_b = portable::hypot(m.lever_b.x, m.lever_b.y) + std::max(0.0, bounds.gap);
  return bounds;
}

template <int K>
GapBounds gap_bounds(const CoordinateMeasure<K>& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  return gap_bounds(measure.along_axis(), offset, a, b);
}

/// Along a shaft of a the gap is the distance from the line over the cosine between them.
inline GapBounds gap_bounds(const GapMeasure& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  GapBounds bounds = gap_bounds(AxisMeasure{measure.point_a, measure.point_b, measure.normal}, 0.0, a, b);
  if (!measure.is_axis_in_a) {
    bounds.gap -= offset;
    return bounds;
  }
  const double cosine = dot(to_ground(b, measure.normal), to_ground(a, measure.axis));
  bounds.gap -= offset * cosine;
  bounds.reach_a += std::abs(offset);
  return bounds;
}

/// Of two circles outside each other; `offset` is the sum of their radii.
inline GapBounds gap_bounds(const DistanceMeasure& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  const auto m = measure.at<false, double>(a, b);
  GapBounds bounds;
  bounds.gap = m.value - offset;
  bounds.normal = m.direction;
  bounds.reach_a = measure.point_a.norm();
  bounds.reach_b = measure.point_b.norm();
  bounds.through = offset;
  return bounds;
}

} // namespace steplap
