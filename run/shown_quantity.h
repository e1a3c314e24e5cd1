// Numbers as people read them: three or four digits, never more than the error lets one say.
//
//   274.0123 kN ± 2 N      274 kN                    the error does not reach a digit that is shown
//   274.0123 kN ± 2 kN     274 kN ± 2 kN             it reaches the last one
//   3e-12 m beside 2 m     0 m                       what is rounding of its scale is zero
// No exponents: a prefix takes their place, chosen by the largest value that stands beside (a column), not by each value.
// All digits that are known: measured_text.h, and the files of a run.
#pragma once

#include "run/quantity_text.h"

#include <optional>
#include <string>

namespace steplap {

/// How many digits are shown.
struct ShownDigits {
  int most = 4;         ///< of a value whose first digit is 1; others have one less (down to 1), which tells as much
  bool is_full = false; ///< all that are known, with their errors, as measured_text writes them

  /// Of a value.
  [[nodiscard]] int of(double value) const;
};

/// What is known of a value besides its size.
struct ShownContext {
  std::optional<double> error = {}; ///< in the value's unit; not-a-number: it is not known how large
  std::optional<double> limit = {}; ///< in the value's unit: an error that reaches it is shown, however small
  double scale = 0.0;               ///< in the value's unit: what is below 1e-9 of it is zero
  double column = 0.0;              ///< in the value's unit: the largest beside it, by which the prefix is chosen; 0: its own size
};

/// The prefix for values up to this size: kN from 1 kN, mm below 1 m, µm below 10 µm, ms below 10 ms.
[[nodiscard]] UnitPrefix shown_prefix(double largest, const std::string& unit);
/// "274 kN", "0.79 mm ± 0.02 mm", "0 m", "1.32"; "–" for not-a-number, "∞". `unit`: SI.
[[nodiscard]] std::string shown_quantity(double value, const std::string& unit, const ShownContext& context = {}, ShownDigits digits = {});
/// Of a share of a limit: "79 %", "99.8 %". It says 100 % only of what is there to the fifth digit.
[[nodiscard]] std::string shown_share(double share, std::optional<double> error = {}, ShownDigits digits = {});
/// Rounded to the digit that stands for 10^last, without an exponent and without zeros behind the point.
[[nodiscard]] std::string rounded_to(double value, int last);

} // namespace steplap
