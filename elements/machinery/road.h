// Road profile y = h(x) in the axes of a marker, flat or a smooth curve through points, and the point of it nearest to a wheel.
//
// A wheel with a radius r smaller than the radius of curvature of all hollows touches the road at one point only. For κ ≤ 1/r the sine of
// the road's inclination increases by at most Δx/r, that of a circle by Δx/r, so a circle that touches the road at one point is above it
// everywhere else. For the same reason the first local minimum of the distance, in the downhill direction from a point, is the global one
// as long as that distance is below 1/κ. The nearest point is therefore found without searching the whole road.
#pragma once

#include "elements/spring_laws.h"
#include "mbd/base/dual.h"
#include "mbd/base/portable_math.h"

#include <cmath>
#include <vector>

namespace steplap {

/// A point of the road, in its axes, m; slope = h'.
template <class S> struct RoadPoint {
  S x{0.0}, height{0.0}, slope{0.0};
};

/// Distance travelled by a wheel's centre along a road, m, with its derivatives with respect to the position of the centre.
template <class S> struct RoadWay {
  S value{0.0}, by_x{1.0}, by_y{0.0};
};

/// The profile of one road.
class Road {
public:
  Road() = default; ///< flat road
  /// Curve through at least two points in ascending order of x, m.
  explicit Road(std::vector<Vec2> points) : is_flat_(false), curve_(std::move(points)) {
    find_hollowest();
    find_pieces();
  }

  [[nodiscard]] bool is_flat() const { return is_flat_; }
  /// Return the largest curvature κ = h″/(1 + h′²)^(3/2) of the hollows of the road, 1/m (0 without hollows), and its position x, m.
  [[nodiscard]] double hollowest() const { return hollowest_; }
  [[nodiscard]] double hollowest_at() const { return hollowest_at_; }

  /// Returns the road point nearest to (x, y), with derivatives with respect to x and y: one Newton step from the point found for doubles.
  template <class S> [[nodiscard]] RoadPoint<S> nearest(const S& x, const S& y) const {
    if (is_flat_) return {x, S(0.0), S(0.0)};
    const double found = nearest_x(value_of(x), value_of(y));
    const CurveJet<double> at = curve_.jet(found);
    const double pull = pull_of(at, value_of(y)), most = 1.0 + at.slope * at.slope;
    const S across = (S(found) - x) + S(at.slope) * (S(at.value) - y); // value zero, but with derivatives
    const S place = S(found) - S(1.0 / (pull > 0.0 ? pull : most)) * across;
    const CurveJet<S> jet = curve_.jet(place);
    return {place, jet.value, jet.slope};
  }

  /// Returns the distance travelled by a wheel with its centre at (x, y): a smooth function whose gradient is the road's direction at the
  /// contact point. For a wheel on the road it is the arc length of the path of the rolling wheel's centre. Above the road it is that
  /// length for the wheel position straight below, plus a term by slope and height. Precondition: the wheel fits in all hollows. `near`: a
  /// nearby position of the road.
  template <class S> [[nodiscard]] RoadWay<S> way(const S& x, const S& y, double radius, double near) const {
    if (is_flat_) return {x, S(1.0), S(0.0)};
    using std::sqrt;
    const double touched = touched_below(value_of(x), radius, near);
    const CurveJet<double> at = curve_.jet(touched);
    const double grown_at = std::sqrt(1.0 + at.slope * at.slope), room = 1.0 - radius * at.curvature / (grown_at * grown_at * grown_at);
    const S ahead = S(1.0 / room) * (x - S(touched - radius * at.slope / grown_at)); // value zero, but with derivatives
    const CurveJet<S> jet = curve_.jet(S(touched) + ahead);
    const S grown = sqrt(S(1.0) + jet.slope * jet.slope), sine = jet.slope / grown, bend = jet.curvature / (grown * grown * grown);
    const S above = y - jet.value - S(radius) / grown;
    const S length = S(length_to(touched)) + S(grown_at) * ahead;
    const S inclined = S(portable::atan2(at.slope, 1.0)) + (jet.slope - S(at.slope)) * S(1.0 / (grown_at * grown_at));
    return {length - S(radius) * inclined + sine * above, S(1.0) / grown + bend / (S(1.0) - S(radius) * bend) * above, sine};
  }

private:
  /// Piece of the spline from a point to the next: y′ = slope + d (bend + d third), with d from the point.
  struct Piece {
    double slope = 0.0, bend = 0.0, third = 0.0;
    double length = 0.0; ///< arc length from the first point of the road to the start of the piece, m
    /// Returns the arc length from the start of the piece over the distance d, m.
    [[nodiscard]] double length_over(double d) const;
  };
  /// Returns the position z, m, at which a wheel with its centre at x touches the road; the search begins at `near`.
  [[nodiscard]] double touched_below(double x, double radius, double near) const;
  /// Returns the arc length of the road from its first point to x, m.
  [[nodiscard]] double length_to(double x) const;
  void find_pieces();
  /// Returns half of the second derivative, with respect to the position, of the squared distance from a point at height y.
  static double pull_of(const CurveJet<double>& at, double y) { return 1.0 + at.slope * at.slope - (y - at.value) * at.curvature; }
  [[nodiscard]] double nearest_x(double x, double y) const;
  void find_hollowest();
  bool is_flat_ = true;
  SmoothCurve curve_;
  double hollowest_ = 0.0, hollowest_at_ = 0.0;
  std::vector<Piece> pieces_; ///< pieces of the spline; the last one continues beyond the last point
};

} // namespace steplap
