// Laws of springs and dampers for LawGroup: linear, with a dead band, and from tables.
#pragma once

#include "mbd/law_group.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace steplap {

/// f = −k (value − free) − c·rate.
struct LinearSpring {
  static constexpr int k_watches = 0;
  static constexpr bool k_is_contact = false;
  double k = 0.0, c = 0.0, free = 0.0;

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, std::uint8_t) const {
    return S(-k) * (value - S(free)) - S(c) * rate;
  }
  [[nodiscard]] double elastic_force(double value, std::uint8_t) const { return -k * (value - free); }
  [[nodiscard]] double energy(double value) const {
    return 0.5 * k * (value - free) * (value - free);
  }
};

/// No force within ± half a gap around the free length, neither elastic nor damping; beyond it a spring
/// and damper from the band's edge on. Modes: 0 below, 1 inside, 2 above the band.
struct GapSpring {
  static constexpr int k_watches = 2;
  static constexpr bool k_is_contact = false;
  double k = 0.0, c = 0.0, free = 0.0, half_gap = 0.0;

  [[nodiscard]] double edge(std::uint8_t mode) const {
    return mode == 0 ? free - half_gap : free + half_gap;
  }
  template <class S> [[nodiscard]] S force(const S& value, const S& rate, std::uint8_t mode) const {
    if (mode == 1) return S(0);
    return S(-k) * (value - S(edge(mode))) - S(c) * rate;
  }
  [[nodiscard]] double elastic_force(double value, std::uint8_t mode) const {
    return mode == 1 ? 0.0 : -k * (value - edge(mode));
  }
  [[nodiscard]] double energy(double value) const {
    const double beyond = std::max(0.0, std::abs(value - free) - half_gap);
    return 0.5 * k * beyond * beyond;
  }
  [[nodiscard]] std::uint8_t mode_at(double value, double) const {
    const double e = value - free;
    return e < -half_gap ? 0 : (e > half_gap ? 2 : 1);
  }
  void watch(double value, double rate, std::uint8_t mode, double* watch, double* watch_rate) const {
    const double low = value - (free - half_gap), high = (free + half_gap) - value;
    watch[0] = mode == 0 ? -low : (mode == 1 ? low : -high);
    watch_rate[0] = mode == 1 ? rate : (mode == 0 ? -rate : rate);
    watch[1] = mode == 1 ? high : 1.0;
    watch_rate[1] = mode == 1 ? -rate : 0.0;
  }
  [[nodiscard]] std::uint8_t next_mode(std::uint8_t mode, int slot, double, double) const {
    if (mode != 1) return 1;
    return slot == 0 ? 0 : 2;
  }
  static const char* transition_name(std::uint8_t, std::uint8_t to) {
    return to == 1 ? "enters its gap" : "closes its gap";
  }
};

/// Piecewise linear characteristic y(x), continued with its end slopes.
class PiecewiseLinear {
public:
  PiecewiseLinear() = default;
  explicit PiecewiseLinear(std::vector<Vec2> points) : points_(std::move(points)) {}
  [[nodiscard]] int segments() const { return std::max(1, static_cast<int>(points_.size()) - 1); }
  [[nodiscard]] double low(int segment) const {
    return segment == 0 ? -1e300 : points_[segment].x();
  }
  [[nodiscard]] double high(int segment) const {
    return segment == segments() - 1 ? 1e300 : points_[segment + 1].x();
  }
  [[nodiscard]] int segment_at(double x) const {
    int s = 0;
    while (s < segments() - 1 && x >= points_[s + 1].x()) ++s;
    return s;
  }
  template <class S> [[nodiscard]] S value(const S& x, int segment) const {
    if (points_.empty()) return S(0);
    const Vec2& p = points_[segment];
    return S(p.y()) + S(slope(segment)) * (x - S(p.x()));
  }
  [[nodiscard]] double slope(int s) const {
    return points_.size() < 2 ? 0.0
                              : (points_[s + 1].y() - points_[s].y()) / (points_[s + 1].x() - points_[s].x());
  }
  /// ∫ from 0 to x.
  [[nodiscard]] double integral(double x) const {
    return primitive(x) - primitive(0.0);
  }

private:
  [[nodiscard]] double primitive(double x) const {
    if (points_.empty()) return 0.0;
    const int last = segment_at(x);
    double sum = 0.0;
    for (int s = 0; s < last; ++s)
      sum += 0.5 * (points_[s].y() + points_[s + 1].y()) * (points_[s + 1].x() - points_[s].x());
    const double d = x - points_[last].x();
    return sum + d * (points_[last].y() + 0.5 * slope(last) * d);
  }
  std::vector<Vec2> points_;
};

/// f = −T(value − free) − D(rate) with tables T, D; the mode is the pair of segments.
struct TabulatedSpring {
  static constexpr int k_watches = 4;
  static constexpr bool k_is_contact = false;
  PiecewiseLinear spring, damper;
  double free = 0.0, count = 1.0;

  [[nodiscard]] int spring_segment(std::uint8_t mode) const { return mode % spring.segments(); }
  [[nodiscard]] int damper_segment(std::uint8_t mode) const { return mode / spring.segments(); }

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, std::uint8_t mode) const {
    return S(-count) * (spring.value(value - S(free), spring_segment(mode)) +
                        damper.value(rate, damper_segment(mode)));
  }
  [[nodiscard]] double elastic_force(double value, std::uint8_t mode) const {
    return -count * spring.value(value - free, spring_segment(mode));
  }
  [[nodiscard]] double energy(double value) const { return count * spring.integral(value - free); }
  [[nodiscard]] std::uint8_t mode_at(double value, double rate) const {
    return static_cast<std::uint8_t>(spring.segment_at(value - free) +
                                     spring.segments() * damper.segment_at(rate));
  }
  void watch(double value, double rate, std::uint8_t mode, double* watch, double* watch_rate) const {
    const int s = spring_segment(mode), d = damper_segment(mode);
    const double e = value - free;
    watch[0] = e - spring.low(s);
    watch[1] = spring.high(s) - e;
    watch[2] = rate - damper.low(d);
    watch[3] = damper.high(d) - rate;
    watch_rate[0] = rate;
    watch_rate[1] = -rate;
  }
  [[nodiscard]] std::uint8_t next_mode(std::uint8_t mode, int slot, double, double) const {
    int s = spring_segment(mode), d = damper_segment(mode);
    if (slot < 2) s += slot == 0 ? -1 : 1;
    else d += slot == 2 ? -1 : 1;
    return static_cast<std::uint8_t>(s + spring.segments() * d);
  }
  static const char* transition_name(std::uint8_t, std::uint8_t) { return "passes a kink of its table"; }
};

} // namespace steplap
