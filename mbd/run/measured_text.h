// Formats a result with its error: "723.123 kN ± 2 N", "0.0851427 s ± 3e-9".
//
// The error is rounded up to one digit, and the value ends at that digit, at most at the 12th. If the error is larger than the value, the
// value is a round number or zero. If the error is unknown (NaN), three digits are shown, and the text says so.
#pragma once

#include <optional>
#include <string>

namespace steplap {

/// Returns the text. `unit` is SI; value and error each get a suitable prefix. NaN is shown as "–". Without an error (not estimated) six
/// digits are shown.
[[nodiscard]] std::string measured_text(double value, std::optional<double> error, const std::string& unit);
/// Returns the text of a time, s; without an error it is rounded to 1 µs.
[[nodiscard]] std::string measured_time_text(double t, std::optional<double> error);

} // namespace steplap
