// Formats numbers with a few digits and a unit, for messages and screens. measured_text.h formats numbers with known errors.
#pragma once

#include <string>

namespace steplap {

/// An SI prefix, for example "k" with exponent −3.
struct UnitPrefix {
  int exponent = 0;      ///< power of ten by which the number is multiplied
  const char* text = ""; ///< "k", "M", …; "" for none
};

/// Returns true if the unit is written with prefixes.
[[nodiscard]] bool takes_prefix(const std::string& unit);
/// Returns a suitable prefix for a value of this size.
[[nodiscard]] UnitPrefix prefix_for(double value, const std::string& unit);

/// Returns six digits with a suitable prefix: 259822.17 N -> "259.822 kN", 7.9e-4 m -> "0.79 mm".
[[nodiscard]] std::string quantity_text(double value, const std::string& unit);
/// Values below this fraction of the scale of their kind are rounding and shown as zero.
inline constexpr double k_shown_as_zero = 1e-9;
/// As quantity_text() above, but a value below k_shown_as_zero times `scale` is shown as zero.
[[nodiscard]] std::string quantity_text(double value, const std::string& unit, double scale);
/// Returns a time, s, with microseconds: "0.085143".
[[nodiscard]] std::string time_text(double t);
/// Returns a number with two digits, for residuals: "2.0e-07".
[[nodiscard]] std::string small_text(double value);

} // namespace steplap
