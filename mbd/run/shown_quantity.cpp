#include "mbd/run/shown_quantity.h"

#include "mbd/run/decimal_digits.h"
#include "mbd/run/measured_text.h"
#include "mbd/run/quantity_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace steplap {

namespace {

// Returns "m/s²" for "m/s^2".
std::string shown_unit(std::string unit) {
  if (const std::size_t at = unit.find("^2"); at != std::string::npos) unit.replace(at, 2, "²");
  return unit;
}

std::string with_unit(const std::string& number, const UnitPrefix& prefix, const std::string& unit) {
  return unit.empty() ? number : number + " " + prefix.text + shown_unit(unit);
}

bool is_scaled(std::string_view unit) {
  static constexpr std::array<std::string_view, 6> k_units{"N", "N m", "J", "W", "Pa", "N/m"};
  return std::find(k_units.begin(), k_units.end(), unit) != k_units.end();
}

bool is_rounding(double value, const ShownContext& context) { return std::abs(value) < k_shown_as_zero * std::abs(context.scale); }

} // namespace

int ShownDigits::of(double value) const { return first_digit(value).digit == 1 ? most : std::max(1, most - 1); }

UnitPrefix shown_prefix(double largest, const std::string& unit) {
  const double size = std::abs(largest);
  if (is_scaled(unit)) {
    if (size >= 1e9) return {-9, "G"};
    if (size >= 1e6) return {-6, "M"};
    if (size >= 1e3) return {-3, "k"};
    return {};
  }
  if (unit == "s") return size > 0.0 && size < 1e-2 ? (size < 1e-5 ? UnitPrefix{6, "µ"} : UnitPrefix{3, "m"}) : UnitPrefix{};
  if (unit != "m" && unit != "rad") return {};
  if (size == 0.0 || size >= (unit == "m" ? 1.0 : 0.1)) return {};
  return size < 1e-5 ? UnitPrefix{6, "µ"} : UnitPrefix{3, "m"};
}

std::string rounded_to(double value, int last) {
  std::string number = rounded_at(value, last);
  if (last < 0) number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

std::string shown_quantity(double value, const std::string& unit, const ShownContext& context, ShownDigits digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "-∞";
  if (digits.is_full) return measured_text(value, context.error, unit);
  if (is_rounding(value, context)) value = 0.0;
  const UnitPrefix prefix = shown_prefix(context.column != 0.0 ? context.column : value, unit);
  const bool is_error_known = context.error && std::isfinite(*context.error);
  const double error = is_error_known ? std::abs(*context.error) : 0.0;
  if (value == 0.0 && (error == 0.0 || is_rounding(error, {.scale = 1e3 * context.scale}) || !is_error_known))
    return with_unit("0", prefix, unit);
  const bool reaches_limit = is_error_known && context.limit && std::abs(value - *context.limit) <= error;
  const double size = value == 0.0 ? error : value;
  int last = exponent_of(size) - digits.of(size) + 1;
  const std::string unknown = context.error && !is_error_known ? " ± unknown" : "";
  const double factor = power_of_ten(prefix.exponent);
  const bool is_reached = error >= 0.5 * power_of_ten(last) || (reaches_limit && error > 0.0);
  if (!is_reached) return with_unit(rounded_to(value * factor, last + prefix.exponent), prefix, unit) + unknown;
  DecimalDigit e = rounded_up(error);
  if (e.exponent < last && !reaches_limit) e = {1, last};
  last = e.exponent + prefix.exponent;
  return with_unit(rounded_to(value * factor, last), prefix, unit) + " ± " +
         with_unit(rounded_to(e.digit * power_of_ten(last), last), prefix, unit);
}

std::string shown_share(double share, std::optional<double> error, ShownDigits digits) {
  if (!std::isfinite(share)) return "–";
  constexpr double k_countless = 1000.0; // utilisation above which no capacity is left (Utilisation::k_most_share)
  if (share >= k_countless && !digits.is_full) return "> 1000 %";
  ShownContext context;
  if (error) context.error = 100.0 * *error;
  context.limit = 100.0;
  context.scale = 1e7; // with this scale percentages below 0.01 are shown as zero
  const double percent = 100.0 * share;
  const bool is_error_shown = error && !(100.0 * std::abs(*error) < std::min(0.5, std::abs(percent - 100.0))) && *error != 0.0;
  if (digits.is_full || is_error_shown) return shown_quantity(percent, "%", context, digits);
  int decimals = std::abs(percent) < 10.0 ? 1 : 0;
  while (decimals < 3 && percent != 100.0 && rounded_to(percent, -decimals) == "100")
    ++decimals; // a value other than 100 % must not be shown as 100 %
  return rounded_to(percent, -decimals) + " %";
}

} // namespace steplap
