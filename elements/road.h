// The profile of a road, y = h(x) in the axes of a marker: flat, or a smooth curve through points; and what of it is nearest to a
// point above.
//
// A wheel whose radius is less than that of the road's hollows touches it in one place only: with κ ≤ 1/r the sine of the road's
// inclination grows by at most Δx/r, that of a circle by Δx/r, so that a circle of radius r that touches the road anywhere lies
// above it everywhere. For the same reason the first place downhill of a point at which its distance is least is the nearest of
// all, as long as that distance is below 1/κ. So the nearest place is found without a search of the whole road.
#pragma once

#include "elements/spring_laws.h"
#include "mbd/math/dual.h"

#include <optional>

namespace steplap {

/// A point of the road, in its axes.
template <class S> struct RoadPoint {
  S x{0.0}, height{0.0}, slope{0.0};
};

class Road {
public:
  Road() = default; ///< flat
  /// At least two points, ascending in x; m.
  explicit Road(std::vector<Vec2> points) : is_flat_(false), curve_(std::move(points)) { find_hollowest(); }

  [[nodiscard]] bool is_flat() const { return is_flat_; }
  /// The largest curvature κ = h″/(1 + h′²)^(3/2) of its hollows, 1/m, and where that is; 0: it has none.
  [[nodiscard]] double hollowest() const { return hollowest_; }
  [[nodiscard]] double hollowest_at() const { return hollowest_at_; }

  /// What is nearest to (x, y), with its derivatives by the place: one step of Newton's method from the place found.
  template <class S> [[nodiscard]] RoadPoint<S> nearest(const S& x, const S& y) const {
    if (is_flat_) return {x, S(0.0), S(0.0)};
    const double found = nearest_x(value_of(x), value_of(y));
    const CurveJet<double> at = curve_.jet(found);
    const double pull = pull_of(at, value_of(y)), most = 1.0 + at.slope * at.slope;
    const S across = (S(found) - x) + S(at.slope) * (S(at.value) - y); // zero, with derivatives
    const S place = S(found) - S(1.0 / (pull > 0.0 ? pull : most)) * across;
    const CurveJet<S> jet = curve_.jet(place);
    return {place, jet.value, jet.slope};
  }

private:
  /// Half of the second derivative of the squared distance from a point at height y, by x.
  static double pull_of(const CurveJet<double>& at, double y) { return 1.0 + at.slope * at.slope - (y - at.value) * at.curvature; }
  [[nodiscard]] double nearest_x(double x, double y) const;
  void find_hollowest();
  bool is_flat_ = true;
  SmoothCurve curve_;
  double hollowest_ = 0.0, hollowest_at_ = 0.0;
};

} // namespace steplap
