// Numbers of a few digits with their units, for messages and screens. measured_text.h writes those whose error is known.
#pragma once

#include <string>

namespace steplap {

/// A prefix of SI, and what it stands for.
struct UnitPrefix {
  int exponent = 0;      ///< the number is to be multiplied by ten to this
  const char* text = ""; ///< before the unit: "k", "M"; "" none
};

/// Is the unit written with prefixes?
[[nodiscard]] bool takes_prefix(const std::string& unit);
/// The one that suits a value of this size.
[[nodiscard]] UnitPrefix prefix_for(double value, const std::string& unit);

/// Six digits with a prefix that suits: 259822.17 N -> "259.822 kN", 7.9e-4 m -> "0.791366 mm".
[[nodiscard]] std::string quantity_text(double value, const std::string& unit);
/// The same; what is rounding beside `scale` (below 1e-9 of it) is zero.
[[nodiscard]] std::string quantity_text(double value, const std::string& unit, double scale);
/// "0.085143"; microseconds are enough to tell events apart on a screen.
[[nodiscard]] std::string time_text(double t);
/// Few digits, for residuals: "2.0e-07".
[[nodiscard]] std::string small_text(double value);

} // namespace steplap
