// Decimal digits of numbers, used to end a printed value at the last digit that its error supports.
#pragma once

#include <string>

namespace steplap {

/// The number digit · 10^exponent with 1 ≤ digit ≤ 9.
struct DecimalDigit {
  int digit = 1, exponent = 0; ///< 0.03 has digit 3 and exponent −2
};

/// Returns the first nonzero digit of |value|, not rounded. The digit is taken from the printed number, because a logarithm may be rounded
/// to the wrong side of a power of ten.
[[nodiscard]] DecimalDigit first_digit(double value);
/// Returns the decimal exponent of the first digit of |value|; 0 if value is 0.
[[nodiscard]] int exponent_of(double value);
/// Returns 10^exponent, correctly rounded.
[[nodiscard]] double power_of_ten(int exponent);
/// Rounds an error (> 0) up to one digit.
[[nodiscard]] DecimalDigit rounded_up(double error);
/// Returns value rounded to a multiple of 10^exponent, such as "274.0": trailing zeros are kept, without exponent notation, and zero has no
/// minus sign.
[[nodiscard]] std::string rounded_at(double value, int exponent);

} // namespace steplap
