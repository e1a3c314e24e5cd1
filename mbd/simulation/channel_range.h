// Minimum and maximum of a channel over a run, as ExtremeFinder (extremes.h) computes them.
#pragma once

#include "mbd/system/system.h"

#include <limits>
#include <optional>

namespace steplap {

/// One end of a channel's range.
struct Extreme {
  double value = std::numeric_limits<double>::quiet_NaN(); ///< value in the unit of the channel; NaN: none
  double t = 0.0;                                          ///< time at which it was reached, s
};

/// Results for one channel.
struct ChannelRange {
  const Channel* channel = nullptr; ///< a channel of the system, which must outlive this object
  Extreme low, high;                ///< minimum and maximum; NaN if the channel had no value or has no extremes (Channel::has_extremes)
  double first = 0.0;               ///< value at the start
  double final = 0.0;               ///< value at the end
  double final_rate = std::numeric_limits<double>::quiet_NaN(); ///< time derivative at the end, in the unit per s; NaN: unknown
  double final_bend = 0.0; ///< second time derivative at the end, in the unit per s²; 0 if unknown (ExtremeFinder::finish_bends())
  /// Accuracy to which the extremes are located; excesses smaller than this were not searched for. Infinite: the true extremes may be
  /// arbitrarily larger.
  double resolution = 0.0;
  /// Amount by which low and high exceed the values at times when the direction of every slip was known; NaN if there were no such times.
  double unsure_low = 0.0, unsure_high = 0.0;
  bool had_no_value = false; ///< the value was NaN at some time
  /// The extreme was reached near a singular position of joints, where reactions may diverge.
  bool is_low_singular = false, is_high_singular = false;
  std::optional<double> first_above_one; ///< time, s, at which a channel without unit first exceeded 1

  /// Returns low or high, whichever has the larger absolute value.
  [[nodiscard]] const Extreme& largest() const;
};

/// A range below this fraction of the largest value of channels with the same unit is only rounding.
inline constexpr double k_rounded_range = 1e-12;

} // namespace steplap
