#include "mbd/run/quantity_text.h"

#include "mbd/base/portable_math.h"

#include <cmath>
#include <cstdio>

namespace steplap {

namespace {

std::string formatted(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

} // namespace

bool takes_prefix(const std::string& unit) {
  return unit == "N" || unit == "N m" || unit == "J" || unit == "Pa" || unit == "m" || unit == "rad";
}

// Lengths are shown in millimetres, because displacements and gaps are more frequent than sizes of machines.
UnitPrefix prefix_for(double value, const std::string& unit) {
  const double size = std::abs(value);
  if (!takes_prefix(unit)) return {};
  if (unit != "m" && unit != "rad") {
    if (size >= 1e6) return {-6, "M"};
    if (size >= 1e3) return {-3, "k"};
    return {};
  }
  if (size > 0.0 && size < 1e-6) return {6, "µ"};
  if (size > 0.0 && size < 0.1) return {3, "m"};
  return {};
}

std::string quantity_text(double value, const std::string& unit) {
  const UnitPrefix prefix = prefix_for(value, unit);
  const double factor = portable::pow(10.0, prefix.exponent);
  const std::string number = formatted("%.6g", value * factor + 0.0);
  return unit.empty() ? number : number + " " + prefix.text + unit;
}

std::string quantity_text(double value, const std::string& unit, double scale) {
  return quantity_text(std::abs(value) < k_shown_as_zero * std::abs(scale) ? 0.0 : value, unit);
}

std::string time_text(double t) { return formatted("%.6f", t); }

std::string small_text(double value) { return formatted("%.2g", value); }

} // namespace steplap
