// Detects a free fall in a record. A falling recorder reads zero on all axes, including gravity.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace steplap::assess {

/// Receives samples as read, m/s², and keeps the longest interval in which the magnitude of all axes is below 0.3 g.
class FallWatch {
public:
  static constexpr double k_weightless = 0.3 * 9.80665;   ///< m/s²; jolts of a road do not stay below this for k_least
  static constexpr double k_gravity_seen = 0.7 * 9.80665; ///< m/s²; smallest reading at rest of a recorder that includes gravity
  static constexpr double k_least = 0.1;                  ///< s; a fall of 5 cm

  /// Must be called at each begin of a segment: a fall cannot extend across a gap.
  void begin_segment() { is_inside_ = false; }
  /// Adds a sample with `axes` values.
  void put(double t, const double* a, std::size_t axes) {
    double size = 0.0;
    for (std::size_t i = 0; i < axes; ++i) size += a[i] * a[i];
    if (size >= k_weightless * k_weightless) is_inside_ = false;
    else if (!is_inside_) is_inside_ = true, from_ = t;
    else if (t - from_ > longest_) longest_ = t - from_, at_ = from_;
  }
  [[nodiscard]] double longest() const { return longest_; } ///< s
  [[nodiscard]] double at() const { return at_; }           ///< begin of the interval, s

private:
  bool is_inside_ = false;
  double from_ = 0.0, longest_ = 0.0, at_ = 0.0;
};

} // namespace steplap::assess
