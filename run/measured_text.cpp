#include "run/measured_text.h"

#include "run/quantity_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace steplap {

namespace {

constexpr int k_most_digits = 12;
constexpr int k_digits_of_unknown = 3;

// m · 10^exponent, 1 <= m <= 9
struct OneDigit {
  int digit = 1, exponent = 0;
};

// Of the decimal digits that are written, not of a logarithm, which rounding may put on the wrong side of a power of ten.
OneDigit decimal(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return {text[0] - '0', std::atoi(std::strchr(text, 'e') + 1)};
}

OneDigit rounded_up(double error) {
  OneDigit d = decimal("%.15e", error); // its first digit, not rounded
  char text[32];
  std::snprintf(text, sizeof text, "%de%d", d.digit, d.exponent);
  constexpr double k_as_good_as = 1.0 + 1e-12;
  if (error > k_as_good_as * std::strtod(text, nullptr)) ++d.digit;
  if (d.digit == 10) d = {1, d.exponent + 1};
  return d;
}

int exponent_of(double value) { return value == 0.0 ? 0 : decimal("%.15e", std::abs(value)).exponent; }

double power_of_ten(int exponent) {
  char text[16];
  std::snprintf(text, sizeof text, "1e%d", exponent);
  return std::strtod(text, nullptr);
}

std::string plain(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  if (std::strtod(text, nullptr) == 0.0 && text[0] == '-') return text + 1; // no minus before a zero
  return text;
}

// To the digit that stands for 10^exponent.
std::string rounded(double value, int exponent) {
  if (exponent <= 0) return plain(value, -exponent);
  const double step = power_of_ten(exponent);
  return plain(std::round(value / step) * step, 0);
}

std::string digit_text(const OneDigit& d) {
  constexpr int k_longest = 4; // 0.0003, but 3e-5
  if (d.exponent >= -k_longest && d.exponent <= k_longest) return plain(d.digit * power_of_ten(d.exponent), std::max(0, -d.exponent));
  return std::to_string(d.digit) + "e" + std::to_string(d.exponent);
}

// With the prefix of its own where the unit takes one.
std::string error_text(const OneDigit& d, const std::string& unit) {
  struct Step {
    int exponent;
    const char* text;
  };
  static constexpr std::array<Step, 6> k_steps{{{6, "M"}, {3, "k"}, {0, ""}, {-3, "m"}, {-6, "µ"}, {-9, "n"}}};
  if (!takes_prefix(unit)) return digit_text(d);
  const bool is_length = unit == "m" || unit == "rad"; // nanometres are read; millinewtons are not
  for (const Step& step : k_steps)
    if (d.exponent >= step.exponent && d.exponent < step.exponent + 3 && (is_length || step.exponent >= 0))
      return digit_text({d.digit, d.exponent - step.exponent}) + " " + step.text + unit;
  return digit_text(d) + " " + unit;
}

bool is_zero(const std::string& number) { return number.find_first_not_of("0.") == std::string::npos; }

std::string with_unit(const std::string& number, const UnitPrefix& prefix, const std::string& unit) {
  if (is_zero(number)) return unit.empty() ? "0" : "0 " + unit;
  return unit.empty() ? number : number + " " + prefix.text + unit;
}

} // namespace

std::string measured_text(double value, std::optional<double> error, const std::string& unit) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "-∞";
  if (!error) return quantity_text(value, unit);
  UnitPrefix prefix = prefix_for(value, unit);
  if (!std::isfinite(*error)) {
    const int last = exponent_of(value) + prefix.exponent - k_digits_of_unknown + 1;
    return with_unit(rounded(value * power_of_ten(prefix.exponent), last), prefix, unit) + " ± unknown";
  }
  if (*error == 0.0) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", k_most_digits, value * power_of_ten(prefix.exponent) + 0.0);
    return with_unit(text, prefix, unit) + " ± 0";
  }
  OneDigit last = rounded_up(std::abs(*error));
  if (const int least = exponent_of(value) - k_most_digits + 1; value != 0.0 && last.exponent < least) last = {1, least};
  if (std::abs(value) < *error) prefix = prefix_for(last.digit * power_of_ten(last.exponent), unit);
  return with_unit(rounded(value * power_of_ten(prefix.exponent), last.exponent + prefix.exponent), prefix, unit) + " ± " +
         error_text(last, unit);
}

std::string measured_time_text(double t, std::optional<double> error) {
  return error ? measured_text(t, error, "s") : time_text(t) + " s";
}

} // namespace steplap
