// Intervals of a design variable in which all limits hold, and their text for the answer.
#pragma once

#include "tools/study/crossing.h"
#include "tools/study/line_scan.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace steplap::study {

/// One end of an interval in which all limits hold.
struct HoldingEnd {
  double value = 0.0; ///< without a target probability the last value tried at which all limits hold; with one the estimated border
  /// confidence interval of the border; NaN: none
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN();
  bool is_range_end = false; ///< true if the range, or the list of values, ends here
  double beyond = 0.0;       ///< the nearest value tried that does not hold; undefined at an end of the range
};

/// An interval in which all values tried hold.
struct HoldingInterval {
  HoldingEnd from, to;
};

/// Locates the sign changes between the points of `samples`, each in an interval of width `tolerance` times its value. Returns them in
/// ascending order. Precondition: no sample is zero or NaN.
[[nodiscard]] std::vector<Crossing> closed_crossings(const LineFunction& function, const LineSamples& samples, double tolerance);

/// Returns the intervals in which the samples are positive. They end at the positive ends of the crossings, one per sign change; if
/// `crossings` is empty, at the outermost positive samples.
[[nodiscard]] std::vector<HoldingInterval> holding_intervals(const LineSamples& samples, const std::vector<Crossing>& crossings);

/// Returns `value` with unit and `digits` digits, rounded up or down: "31.9772 kPa".
[[nodiscard]] std::string rounded_quantity(double value, const std::string& unit, bool is_up, int digits);

/// Returns a text: "from 31.9772 kPa to 100 kPa (the end of the range) and from …". Ends are rounded inwards, so that the printed values
/// hold. If `confidence` is given, 0 to 1, the confidence intervals of the ends are added in brackets.
[[nodiscard]] std::string intervals_text(const std::vector<HoldingInterval>& intervals, const std::string& unit, int digits,
                                         std::optional<double> confidence);

} // namespace steplap::study
