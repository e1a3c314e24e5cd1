#include "mbd/run/decimal_digits.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace steplap {

namespace {

std::string plain(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  if (std::strtod(text, nullptr) == 0.0 && text[0] == '-') return text + 1; // avoids "-0"
  return text;
}

} // namespace

DecimalDigit first_digit(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15e", std::abs(value));
  return {text[0] - '0', std::atoi(std::strchr(text, 'e') + 1)};
}

int exponent_of(double value) { return value == 0.0 ? 0 : first_digit(value).exponent; }

double power_of_ten(int exponent) {
  char text[16];
  std::snprintf(text, sizeof text, "1e%d", exponent);
  return std::strtod(text, nullptr);
}

DecimalDigit rounded_up(double error) {
  DecimalDigit d = first_digit(error);
  char text[32];
  std::snprintf(text, sizeof text, "%de%d", d.digit, d.exponent);
  constexpr double k_as_good_as = 1.0 + 1e-12;
  if (error > k_as_good_as * std::strtod(text, nullptr)) ++d.digit;
  return d.digit == 10 ? DecimalDigit{1, d.exponent + 1} : d;
}

std::string rounded_at(double value, int exponent) {
  if (exponent <= 0) return plain(value, -exponent);
  const double step = power_of_ten(exponent);
  return plain(std::round(value / step) * step, 0);
}

} // namespace steplap
