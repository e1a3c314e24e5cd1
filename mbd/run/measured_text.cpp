#include "mbd/run/measured_text.h"

#include "mbd/run/decimal_digits.h"
#include "mbd/run/quantity_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace steplap {

namespace {

constexpr int k_most_digits = 12;
constexpr int k_digits_of_unknown = 3;

std::string digit_text(const DecimalDigit& d) {
  constexpr int k_longest = 4; // largest magnitude of the exponent that is written without "e": 0.0003, but 3e-5
  if (d.exponent >= -k_longest && d.exponent <= k_longest) return rounded_at(d.digit * power_of_ten(d.exponent), std::min(0, d.exponent));
  return std::to_string(d.digit) + "e" + std::to_string(d.exponent);
}

// Formats the error with its own prefix if the unit takes one.
std::string error_text(const DecimalDigit& d, const std::string& unit) {
  struct Step {
    int exponent;
    const char* text;
  };
  static constexpr std::array<Step, 6> k_steps{{{6, "M"}, {3, "k"}, {0, ""}, {-3, "m"}, {-6, "µ"}, {-9, "n"}}};
  if (!takes_prefix(unit)) return digit_text(d);
  const bool is_length = unit == "m" || unit == "rad"; // nanometres are customary; millinewtons are not
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
    return with_unit(rounded_at(value * power_of_ten(prefix.exponent), last), prefix, unit) + " ± unknown";
  }
  if (*error == 0.0) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", k_most_digits, value * power_of_ten(prefix.exponent) + 0.0);
    return with_unit(text, prefix, unit) + " ± 0";
  }
  DecimalDigit last = rounded_up(std::abs(*error));
  if (const int least = exponent_of(value) - k_most_digits + 1; value != 0.0 && last.exponent < least) last = {1, least};
  if (std::abs(value) < *error) prefix = prefix_for(last.digit * power_of_ten(last.exponent), unit);
  return with_unit(rounded_at(value * power_of_ten(prefix.exponent), last.exponent + prefix.exponent), prefix, unit) + " ± " +
         error_text(last, unit);
}

std::string measured_time_text(double t, std::optional<double> error) { return error ? measured_text(t, error, "s") : time_text(t) + " s"; }

} // namespace steplap
