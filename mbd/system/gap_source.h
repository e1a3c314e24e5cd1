// Lower bounds of the distances between bodies, for searches that move bodies by finite steps and must not pass through thin parts.
//
// The gap is negative in contact. The points of the touching surfaces are within `reach_a` and `reach_b` of the centres of gravity. A
// relative displacement d of the centres and rotations φ_a, φ_b therefore reduce the gap by at most |d| + |φ_a| reach_a + |φ_b| reach_b.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace steplap {

/// Bounds for the gap of one contact between bodies a and b.
struct GapBounds {
  int a = k_ground, b = k_ground;
  double gap = 0.0;                    ///< m
  Pair<double> normal;                 ///< unit normal, ground axes, in the direction of a contact force on a
  double reach_a = 0.0, reach_b = 0.0; ///< m
  /// Penetration, m, at which one part is entirely through the other, so that the force would push it out on the far side. Infinite if this
  /// cannot happen.
  double through = std::numeric_limits<double>::infinity();
};

/// Additional interface of a force group whose contacts can compute gap bounds.
class GapSource {
public:
  virtual ~GapSource() = default;
  /// Appends the gap bounds of all contacts for bodies at `motion`, whatever their modes.
  virtual void add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const = 0;
};

/// Returns the bounds for a point of a above a line of b, in contact where `measure` is below `offset`. The line has no far side.
inline GapBounds gap_bounds(const AxisMeasure& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  const auto m = measure.at<false, double>(a, b);
  GapBounds bounds;
  bounds.gap = m.value - offset;
  bounds.normal = m.direction;
  bounds.reach_a = measure.point_a.norm();
  // The point of the line next to the tip moves away from b's centre by at most the decrease of the gap.
  bounds.reach_b = portable::hypot(m.lever_b.x, m.lever_b.y) + std::max(0.0, bounds.gap);
  return bounds;
}

template <int K>
GapBounds gap_bounds(const CoordinateMeasure<K>& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  return gap_bounds(measure.along_axis(), offset, a, b);
}

/// Returns the bounds for a contact axis that is fixed in a: the gap along it is the distance from the line over the cosine of the angle
/// between axis and normal.
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

/// Returns the bounds for two circles outside each other; `offset` is the sum of their radii.
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
