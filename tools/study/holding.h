// Intervals of a design variable in which all limits hold, and their description in words.
#pragma once

#include "tools/study/crossing.h"
#include "tools/study/line_scan.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace steplap::study {

/// An end of an interval of values that hold.
struct HoldingEnd {
  double value = 0.0; ///< the last value known to hold, or the best estimate of the border
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN(); ///< interval of the border
  bool is_range_end = false; ///< true if the range, or the list of values, ends here
  double beyond = 0.0;       ///< the nearest value known not to hold; no meaning at an end of the range
};

/// Values from `from` to `to` hold as far as they were tried.
struct HoldingInterval {
  HoldingEnd from, to;
};

/// Reduces each interval of `samples` at whose ends the function has different signs until it is `tolerance` times its values wide.
/// Returns one crossing for each, in ascending order. The function has no zeros and a value everywhere.
[[nodiscard]] std::vector<Crossing> closed_crossings(const LineFunction& function, const LineSamples& samples, double tolerance);

/// Returns the intervals in which samples are positive. They end at the positive ends of `crossings`, one for each change of sign; without
/// crossings, at the last positive samples.
[[nodiscard]] std::vector<HoldingInterval> holding_intervals(const LineSamples& samples, const std::vector<Crossing>& crossings);

/// Returns `value` with unit and `digits` digits, rounded up or down: "31.9772 kPa".
[[nodiscard]] std::string rounded_quantity(double value, const std::string& unit, bool is_up, int digits);

/// Returns the intervals in words: "from 31.9772 kPa to 100 kPa (the end of the range) and from …". Ends are rounded inwards, so that the
/// values printed hold. With `confidence`, 0 to 1, the intervals of ends are added in brackets.
[[nodiscard]] std::string intervals_text(const std::vector<HoldingInterval>& intervals, const std::string& unit, int digits,
                                         std::optional<double> confidence);

} // namespace steplap::study
