// A number with its error, as everything that comes out of a run is written: "723.123 kN ± 2 N", "0.0851427 s ± 3e-9".
//
// The error has one digit, rounded up. The value ends at that digit: none is written that is not known, and of those
// that are known none is left out, up to the 12th. Where the error is larger than the value, what is left of the value
// is a round number or zero. An unknown error (not-a-number) leaves three digits to go by, and says so.
#pragma once

#include <optional>
#include <string>

namespace steplap {

/// `unit`: SI; value and error each get a prefix that suits, where the unit takes one. "–" for not-a-number, "∞".
/// No error: it was not estimated; six digits then.
[[nodiscard]] std::string measured_text(double value, std::optional<double> error, const std::string& unit);
/// Of an instant, s; without an error to the microsecond.
[[nodiscard]] std::string measured_time_text(double t, std::optional<double> error);

} // namespace steplap
