// Formats numbers for people: three or four digits, and no more than the error supports.
//
//   274.0123 kN ± 2 N                274 kN           the error is smaller than the last digit shown
//   274.0123 kN ± 2 kN               274 kN ± 2 kN    the error affects the last digit shown
//   3e-12 m in a scene of size 2 m   0 m              rounding error at this scale
//
// A prefix replaces exponents. All values of a column get the same prefix, chosen by the largest value. measured_text.h and the files of a
// run give all known digits.
#pragma once

#include "mbd/run/quantity_text.h"

#include <optional>
#include <string>

namespace steplap {

/// Number of digits shown.
struct ShownDigits {
  int most = 4; ///< digits of a value whose first digit is 1; other values have one less (at least 1), which is the same relative precision
  bool is_full = false; ///< true: all known digits with their errors, as in measured_text.h

  /// Returns the number of digits for a value.
  [[nodiscard]] int of(double value) const;
};

/// Additional data about a value.
struct ShownContext {
  std::optional<double> error = {}; ///< in the value's unit; NaN: unknown
  std::optional<double> limit = {}; ///< in the value's unit; an error that reaches this limit is always shown
  double scale = 0.0;               ///< in the value's unit; values below 1e-9 of it are shown as zero
  double column = 0.0;              ///< largest value of the column, which determines the prefix, in the value's unit; 0: the value itself
};

/// Returns the prefix for values up to `largest`, in SI: kN from 1 kN, mm below 1 m, µm below 10 µm, ms below 10 ms.
[[nodiscard]] UnitPrefix shown_prefix(double largest, const std::string& unit);
/// Returns "274 kN", "0.79 mm ± 0.02 mm", "0 m", "1.32"; "–" for NaN; "∞". `unit` is SI.
[[nodiscard]] std::string shown_quantity(double value, const std::string& unit, const ShownContext& context = {}, ShownDigits digits = {});
/// Returns a utilisation in percent: "79 %", "99.8 %". "100 %" is shown only if the first five digits agree.
[[nodiscard]] std::string shown_share(double share, std::optional<double> error = {}, ShownDigits digits = {});
/// Returns value rounded to a multiple of 10^last, without exponent and without trailing zeros after the point.
[[nodiscard]] std::string rounded_to(double value, int last);

} // namespace steplap
