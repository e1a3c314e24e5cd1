// Spring and damper laws for LawGroup: linear, with a dead band, and tabulated (piecewise linear or smooth).
#pragma once

#include "mbd/system/law_group.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace steplap {

/// f = −k (value − free) − c·rate.
struct LinearSpring {
  static constexpr int k_event_count = 0;
  static constexpr bool k_is_contact = false;
  double k = 0.0, c = 0.0, free = 0.0;

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode) const {
    return S(-k) * (value - S(free)) - S(c) * rate;
  }
  template <class S> [[nodiscard]] S elastic_force(const S& value, UnitMode) const { return -k * (value - free); }
  [[nodiscard]] double energy(double value) const { return 0.5 * k * (value - free) * (value - free); }
};

/// Linear spring and damper with a dead band of half_gap on both sides of the free length, within which the force is zero. Outside,
/// elongation is measured from the edge of the band. Modes: 0 below, 1 inside, 2 above the band.
struct GapSpring {
  static constexpr int k_event_count = 2;
  static constexpr bool k_is_contact = false;
  double k = 0.0, c = 0.0, free = 0.0, half_gap = 0.0;

  [[nodiscard]] double edge(UnitMode mode) const { return mode == 0 ? free - half_gap : free + half_gap; }
  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    if (mode == 1) return S(0);
    return S(-k) * (value - S(edge(mode))) - S(c) * rate;
  }
  template <class S> [[nodiscard]] S elastic_force(const S& value, UnitMode mode) const {
    if (mode == 1) return S(0);
    return -k * (value - edge(mode));
  }
  [[nodiscard]] double energy(double value) const {
    const double beyond = std::max(0.0, std::abs(value - free) - half_gap);
    return 0.5 * k * beyond * beyond;
  }
  [[nodiscard]] UnitMode initial_mode(double value, double) const {
    const double e = value - free;
    return e < -half_gap ? 0 : (e > half_gap ? 2 : 1);
  }
  template <class S> void event_value(const S& value, const S& rate, UnitMode mode, S* event_value, S* event_derivative) const {
    const S low = value - (free - half_gap), high = (free + half_gap) - value;
    event_value[0] = mode == 0 ? -low : (mode == 1 ? low : -high);
    event_derivative[0] = mode == 1 ? rate : (mode == 0 ? -rate : rate);
    event_value[1] = mode == 1 ? high : S(1.0);
    event_derivative[1] = mode == 1 ? -rate : S(0.0);
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double, double, double) const {
    if (mode != 1) return 1;
    return slot == 0 ? 0 : 2;
  }
  static EventKind event_kind(UnitMode, UnitMode to) { return to == 1 ? EventKind::enters_gap : EventKind::closes_gap; }
};

/// Piecewise linear function y(x), extrapolated with the slopes at its ends.
class PiecewiseLinear {
public:
  static constexpr std::size_t k_most_points = 1U << 16U; ///< two segment indices must fit into a UnitMode

  PiecewiseLinear() = default;
  explicit PiecewiseLinear(std::vector<Vec2> points) : points_(std::move(points)) {
    primitive_.resize(points_.size());
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Vec2 &a = points_[i - 1], &b = points_[i];
      primitive_[i] = primitive_[i - 1] + 0.5 * (a.y() + b.y()) * (b.x() - a.x());
    }
    at_zero_ = primitive(0.0);
  }
  [[nodiscard]] int segments() const { return std::max(1, static_cast<int>(points_.size()) - 1); }
  [[nodiscard]] double low(int segment) const { return segment == 0 ? -1e300 : points_[segment].x(); }
  [[nodiscard]] double high(int segment) const { return segment == segments() - 1 ? 1e300 : points_[segment + 1].x(); }
  [[nodiscard]] int segment_at(double x) const {
    if (points_.size() < 3) return 0;
    const auto after =
        std::upper_bound(points_.begin() + 1, points_.end() - 1, x, [](double value, const Vec2& p) { return value < p.x(); });
    return static_cast<int>(after - points_.begin()) - 1;
  }
  /// Returns the segment that contains x, on the given side of `segment`. If x has jumped, several segments are skipped.
  [[nodiscard]] int segment_beyond(int segment, bool is_above, double x) const {
    const int now = segment_at(x);
    return is_above ? std::min(std::max(segment + 1, now), segments() - 1) : std::max(std::min(segment - 1, now), 0);
  }
  template <class S> [[nodiscard]] S value(const S& x, int segment) const {
    if (points_.empty()) return S(0);
    const Vec2& p = points_[segment];
    return S(p.y()) + S(slope(segment)) * (x - S(p.x()));
  }
  [[nodiscard]] double slope(int s) const {
    return points_.size() < 2 ? 0.0 : (points_[s + 1].y() - points_[s].y()) / (points_[s + 1].x() - points_[s].x());
  }
  /// Returns ∫ y dx from 0 to x.
  [[nodiscard]] double integral(double x) const { return primitive(x) - at_zero_; }

private:
  [[nodiscard]] double primitive(double x) const {
    if (points_.empty()) return 0.0;
    const int s = segment_at(x);
    const double d = x - points_[s].x();
    return primitive_[s] + d * (points_[s].y() + 0.5 * slope(s) * d);
  }
  std::vector<Vec2> points_;
  std::vector<double> primitive_; ///< integral from the first point to each point
  double at_zero_ = 0.0;
};

/// Value and derivatives of a curve y(x) at one point.
template <class S> struct CurveJet {
  S value{0.0}, slope{0.0}, curvature{0.0}; ///< y, y′, y″
};

/// Smooth function y(x) through points: the natural cubic spline (continuous second derivative, zero curvature at both ends), extrapolated
/// linearly.
class SmoothCurve {
public:
  SmoothCurve() = default;
  /// Requires at least two points in ascending order of x.
  explicit SmoothCurve(std::vector<Vec2> points) : points_(std::move(points)) {
    find_curvatures();
    primitive_.resize(points_.size());
    for (std::size_t i = 1; i < points_.size(); ++i)
      primitive_[i] = primitive_[i - 1] + from_left(i - 1, points_[i].x() - points_[i - 1].x());
    at_zero_ = primitive(0.0);
  }
  template <class S> [[nodiscard]] S value(const S& x) const {
    const std::size_t i = piece_at(value_of(x));
    const Coefficients c = coefficients(i);
    const S d = x - S(points_[i].x());
    const double width = points_[i + 1].x() - points_[i].x();
    if (value_of(d) < 0.0) return S(points_[i].y()) + S(c.slope) * d;
    if (value_of(d) > width) return S(points_[i + 1].y()) + S(end_slope(c, width)) * (d - S(width));
    return S(points_[i].y()) + d * (S(c.slope) + d * (S(0.5 * curvature_[i]) + d * S(c.cubic)));
  }
  /// Returns the value with two derivatives.
  template <class S> [[nodiscard]] CurveJet<S> jet(const S& x) const {
    const std::size_t i = piece_at(value_of(x));
    const Coefficients c = coefficients(i);
    const double width = points_[i + 1].x() - points_[i].x();
    const S d = x - S(points_[i].x());
    if (value_of(d) < 0.0) return {S(points_[i].y()) + S(c.slope) * d, S(c.slope), S(0.0)};
    if (value_of(d) > width) return {S(points_[i + 1].y()) + S(end_slope(c, width)) * (d - S(width)), S(end_slope(c, width)), S(0.0)};
    return {S(points_[i].y()) + d * (S(c.slope) + d * (S(0.5 * curvature_[i]) + d * S(c.cubic))),
            S(c.slope) + d * (S(curvature_[i]) + d * S(3.0 * c.cubic)), S(curvature_[i]) + d * S(6.0 * c.cubic)};
  }
  [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
  /// Returns ∫ y dx from 0 to x.
  [[nodiscard]] double integral(double x) const { return primitive(x) - at_zero_; }

private:
  struct Coefficients {
    double slope = 0.0, cubic = 0.0; ///< y′ at the left end of the piece; y‴/6
  };
  // Computes y″ at the points: continuity of y′ gives a tridiagonal system.
  void find_curvatures() {
    const std::size_t n = points_.size();
    curvature_.assign(n, 0.0);
    std::vector<double> above(n, 0.0); // upper diagonal after elimination
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double left = points_[i].x() - points_[i - 1].x(), right = points_[i + 1].x() - points_[i].x();
      const double bend = (points_[i + 1].y() - points_[i].y()) / right - (points_[i].y() - points_[i - 1].y()) / left;
      const double pivot = 2.0 * (left + right) - left * above[i - 1];
      above[i] = right / pivot;
      curvature_[i] = (6.0 * bend - left * curvature_[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 1;) curvature_[i] -= above[i] * curvature_[i + 1];
  }
  [[nodiscard]] Coefficients coefficients(std::size_t i) const {
    const double width = points_[i + 1].x() - points_[i].x();
    return {(points_[i + 1].y() - points_[i].y()) / width - width * (2.0 * curvature_[i] + curvature_[i + 1]) / 6.0,
            (curvature_[i + 1] - curvature_[i]) / (6.0 * width)};
  }
  /// Returns y′ at the right end of the last piece, where the curvature is zero.
  [[nodiscard]] double end_slope(const Coefficients& c, double width) const {
    return c.slope + width * (curvature_[curvature_.size() - 2] + 3.0 * c.cubic * width);
  }
  [[nodiscard]] std::size_t piece_at(double x) const {
    if (points_.size() < 3) return 0;
    const auto after =
        std::upper_bound(points_.begin() + 1, points_.end() - 1, x, [](double value, const Vec2& p) { return value < p.x(); });
    return static_cast<std::size_t>(after - points_.begin()) - 1;
  }
  /// Returns ∫ y dx from the left end of piece i over the length d.
  [[nodiscard]] double from_left(std::size_t i, double d) const {
    const Coefficients c = coefficients(i);
    return d * (points_[i].y() + d * (c.slope / 2.0 + d * (curvature_[i] / 6.0 + d * c.cubic / 4.0)));
  }
  [[nodiscard]] double primitive(double x) const {
    const std::size_t i = piece_at(x);
    const double d = x - points_[i].x(), width = points_[i + 1].x() - points_[i].x();
    if (d < 0.0) return primitive_[i] + d * (points_[i].y() + 0.5 * coefficients(i).slope * d);
    if (d <= width) return primitive_[i] + from_left(i, d);
    const double beyond = d - width;
    return primitive_[i + 1] + beyond * (points_[i + 1].y() + 0.5 * end_slope(coefficients(i), width) * beyond);
  }
  std::vector<Vec2> points_;
  std::vector<double> curvature_; ///< y″ at each point
  std::vector<double> primitive_; ///< integral from the first point to each point
  double at_zero_ = 0.0;
};

/// f = −T(value − free) − D(rate) with smooth curves T, D. It has a single mode and no events.
struct SmoothSpring {
  static constexpr int k_event_count = 0;
  static constexpr bool k_is_contact = false;
  SmoothCurve spring, damper;
  double free = 0.0, count = 1.0;

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode) const {
    return S(-count) * (spring.value(value - S(free)) + damper.value(rate));
  }
  // Only for double, because a tape cannot record the choice of the piece.
  [[nodiscard]] double elastic_force(double value, UnitMode) const { return -count * spring.value(value - free); }
  [[nodiscard]] double energy(double value) const { return count * spring.integral(value - free); }
  /// Returns the points of the curve as knots of the relative angle.
  [[nodiscard]] std::vector<TurnKnots> knots() const {
    TurnKnots knots{-free, {}};
    for (const Vec2& point : spring.points()) knots.at.push_back(point.x());
    return {knots};
  }
};

/// f = −T(value − free) − D(rate) with tables T, D. The mode is the pair of segments. Event functions are the ends of the present segments
/// only, so that the cost of a step does not depend on the length of the tables. Segments are extended by the rounding errors of value and
/// rate: a coordinate held by joints varies by rounding, and if it were exactly at a kink the kink would be passed endlessly.
struct TabulatedSpring {
  static constexpr int k_event_count = 4;
  static constexpr bool k_has_events_beyond_rounding = true;
  static constexpr bool k_is_contact = false;
  PiecewiseLinear spring, damper;
  double free = 0.0, count = 1.0;

  static int spring_segment(UnitMode mode) { return static_cast<int>(mode & 0xffffU); }
  static int damper_segment(UnitMode mode) { return static_cast<int>(mode >> 16U); }
  static UnitMode mode_of(int spring_segment, int damper_segment) {
    return static_cast<UnitMode>(spring_segment) | static_cast<UnitMode>(damper_segment) << 16U;
  }

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    return S(-count) * (spring.value(value - S(free), spring_segment(mode)) + damper.value(rate, damper_segment(mode)));
  }
  template <class S> [[nodiscard]] S elastic_force(const S& value, UnitMode mode) const {
    return -count * spring.value(S(value - free), spring_segment(mode));
  }
  [[nodiscard]] double energy(double value) const { return count * spring.integral(value - free); }
  [[nodiscard]] UnitMode initial_mode(double value, double rate) const {
    return mode_of(spring.segment_at(value - free), damper.segment_at(rate));
  }
  static EventTolerance event_tolerance(int slot) { return slot < 2 ? EventTolerance::position : EventTolerance::velocity; }
  template <class S>
  void event_value(const S& value, const S& rate, UnitMode mode, const S& value_known_to, const S& rate_known_to, S* event_value,
                   S* event_derivative) const {
    const int s = spring_segment(mode), d = damper_segment(mode);
    const S e = value - free;
    event_value[0] = e - spring.low(s) + value_known_to;
    event_value[1] = spring.high(s) - e + value_known_to;
    event_value[2] = rate - damper.low(d) + rate_known_to;
    event_value[3] = damper.high(d) - rate + rate_known_to;
    event_derivative[0] = rate;
    event_derivative[1] = -rate;
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double value, double rate, double) const {
    const int s = spring_segment(mode), d = damper_segment(mode);
    const bool is_above = slot == 1 || slot == 3;
    return slot < 2 ? mode_of(spring.segment_beyond(s, is_above, value - free), d) : mode_of(s, damper.segment_beyond(d, is_above, rate));
  }
  static EventKind event_kind(UnitMode, UnitMode) { return EventKind::passes_kink; }
};

} // namespace steplap
