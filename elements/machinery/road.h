// The profile of a road, y = h(x) in the axes of a marker: flat, or a smooth curve through points; and what of it is nearest to a
// point above.
//
// A wheel whose radius is less than that of the road's hollows touches it in one place only: with κ ≤ 1/r the sine of the road's
// inclination grows by at most Δx/r, that of a circle by Δx/r, so that a circle of radius r that touches the road anywhere lies
// above it everywhere. For the same reason the first place downhill of a point at which its distance is least is the nearest of
// all, as long as that distance is below 1/κ. So the nearest place is found without a search of the whole road.
#pragma once

#include "elements/spring_laws.h"
#include "mbd/base/dual.h"
#include "mbd/base/portable_math.h"

#include <cmath>
#include <vector>

namespace steplap {

/// A point of the road, in its axes.
template <class S> struct RoadPoint {
  S x{0.0}, height{0.0}, slope{0.0};
};

/// How far a wheel's centre has come along a road, m, and by how much that grows with its place.
template <class S> struct RoadWay {
  S value{0.0}, by_x{1.0}, by_y{0.0};
};

class Road {
public:
  Road() = default; ///< flat
  /// At least two points, ascending in x; m.
  explicit Road(std::vector<Vec2> points) : is_flat_(false), curve_(std::move(points)) {
    find_hollowest();
    find_pieces();
  }

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

  /// A function of the place (x, y) of a wheel's centre, smooth everywhere, whose gradient is the road's direction where the wheel
  /// touches: there it is the length of the curve that the centre of a wheel that rolls goes along, and above that the length that it
  /// has straight below itself, with what the slope makes of the height. Of a road in whose hollows the wheel finds room. `near`: a place
  /// of the road not far off.
  template <class S> [[nodiscard]] RoadWay<S> way(const S& x, const S& y, double radius, double near) const {
    if (is_flat_) return {x, S(1.0), S(0.0)};
    using std::sqrt;
    const double touched = touched_below(value_of(x), radius, near);
    const CurveJet<double> at = curve_.jet(touched);
    const double grown_at = std::sqrt(1.0 + at.slope * at.slope), room = 1.0 - radius * at.curvature / (grown_at * grown_at * grown_at);
    const S ahead = S(1.0 / room) * (x - S(touched - radius * at.slope / grown_at)); // zero, with derivatives
    const CurveJet<S> jet = curve_.jet(S(touched) + ahead);
    const S grown = sqrt(S(1.0) + jet.slope * jet.slope), sine = jet.slope / grown, bend = jet.curvature / (grown * grown * grown);
    const S above = y - jet.value - S(radius) / grown;
    const S length = S(length_to(touched)) + S(grown_at) * ahead;
    const S inclined = S(portable::atan2(at.slope, 1.0)) + (jet.slope - S(at.slope)) * S(1.0 / (grown_at * grown_at));
    return {length - S(radius) * inclined + sine * above, S(1.0) / grown + bend / (S(1.0) - S(radius) * bend) * above, sine};
  }

private:
  /// From a point to the next: y′ = slope + d (bend + d third), d from the point.
  struct Piece {
    double slope = 0.0, bend = 0.0, third = 0.0;
    double length = 0.0; ///< of the road from its first point to this one, m
    /// Of the road over the first d.
    [[nodiscard]] double length_over(double d) const;
  };
  /// Where a wheel touches whose centre is at x; looked for from `near` on.
  [[nodiscard]] double touched_below(double x, double radius, double near) const;
  /// Of the road, from its first point to x.
  [[nodiscard]] double length_to(double x) const;
  void find_pieces();
  /// Half of the second derivative of the squared distance from a point at height y, by x.
  static double pull_of(const CurveJet<double>& at, double y) { return 1.0 + at.slope * at.slope - (y - at.value) * at.curvature; }
  [[nodiscard]] double nearest_x(double x, double y) const;
  void find_hollowest();
  bool is_flat_ = true;
  SmoothCurve curve_;
  double hollowest_ = 0.0, hollowest_at_ = 0.0;
  std::vector<Piece> pieces_; ///< the last one goes on beyond the last point
};

} // namespace steplap
