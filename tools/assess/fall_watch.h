// Detects a free fall in a record. A falling recorder reads zero on all axes, including gravity.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace steplap::assess {

/// Finds the longest interval in which the magnitude over all axes is below 0.3 g. Receives the samples as read, m/s².
class FallWatch {
public:
  static constexpr double k_weightless = 0.3 * 9.80665;   ///< m/s²; road shocks do not stay below this value for `k_least`
  static constexpr double k_gravity_seen = 0.7 * 9.80665; ///< m/s²; a recorder that reads less at rest does not include gravity
  static constexpr double k_least = 0.1;                  ///< shortest interval, s; corresponds to a fall of 5 cm

  /// Must be called at the begin of each segment, because a fall cannot be followed across a gap.
  void begin_segment() { is_inside_ = false; }
  /// Adds a sample with `axes` values.
  void put(double t, const double* a, std::size_t axes) {
    double size = 0.0;
    for (std::size_t i = 0; i < axes; ++i) size += a[i] * a[i];
    if (size >= k_weightless * k_weightless) is_inside_ = false;
    else if (!is_inside_) is_inside_ = true, from_ = t;
    else if (t - from_ > longest_) longest_ = t - from_, at_ = from_;
  }
  [[nodiscard]] double longest() const { return longest_; } ///< duration of the interval, s
  [[nodiscard]] double at() const { return at_; }           ///< begin of the interval, s

private:
  bool is_inside_ = false;
  double from_ = 0.0, longest_ = 0.0, at_ = 0.0;
};

} // namespace steplap::assess
