// Decimal digits of numbers, as they are written: for texts that end at a digit which an error lets one say.
#pragma once

#include <string>

namespace steplap {

/// digit · 10^exponent, 1 <= digit <= 9.
struct DecimalDigit {
  int digit = 1, exponent = 0; ///< of a number: 3 and -2 stand for 0.03
};

/// The first digit of |value|, not rounded. It is read off the digits that are written: a logarithm may be rounded to the wrong side of
/// a power of ten.
[[nodiscard]] DecimalDigit first_digit(double value);
/// The exponent of the first digit; 0 of zero.
[[nodiscard]] int exponent_of(double value);
/// 10^exponent, correctly rounded.
[[nodiscard]] double power_of_ten(int exponent);
/// An error (> 0) as one digit that is never smaller.
[[nodiscard]] DecimalDigit rounded_up(double error);
/// "274.0": to the digit that stands for 10^exponent, with the zeros behind the point, without an exponent and without a minus before zero.
[[nodiscard]] std::string rounded_at(double value, int exponent);

} // namespace steplap
