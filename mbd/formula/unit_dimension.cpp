#include "mbd/formula/unit_dimension.h"

#include "mbd/base/number_text.h"

#include <cctype>
#include <numbers>

namespace steplap {

namespace {

struct Symbol {
  std::string_view name;
  double factor;
  std::array<double, 3> powers;
  bool takes_prefix;
};

constexpr Symbol k_symbols[] = {
    {"1", 1.0, {0, 0, 0}, false},
    {"m", 1.0, {0, 1, 0}, true},
    {"s", 1.0, {0, 0, 1}, true},
    {"kg", 1.0, {1, 0, 0}, false},
    {"t", 1e3, {1, 0, 0}, false},
    {"N", 1.0, {1, 1, -2}, true},
    {"J", 1.0, {1, 2, -2}, true},
    {"W", 1.0, {1, 2, -3}, true},
    {"Pa", 1.0, {1, -1, -2}, true},
    {"bar", 1e5, {1, -1, -2}, true},
    {"rad", 1.0, {0, 0, 0}, true},
    {"deg", std::numbers::pi / 180.0, {0, 0, 0}, false},
    {"degree", std::numbers::pi / 180.0, {0, 0, 0}, false},
    {"percent", 0.01, {0, 0, 0}, false},
    {"%", 0.01, {0, 0, 0}, false},
    {"min", 60.0, {0, 0, 1}, false},
    {"h", 3600.0, {0, 0, 1}, false},
    {"gravity", 9.80665, {0, 1, -2}, false},
    // Electric units and the kelvin are dimensionless here, like radians. Volt times ampere must still give watts.
    {"A", 1.0, {0, 0, 0}, true},
    {"K", 1.0, {0, 0, 0}, true},
    {"C", 1.0, {0, 0, 1}, true},
    {"V", 1.0, {1, 2, -3}, true},
    {"ohm", 1.0, {1, 2, -3}, true},
    {"F", 1.0, {-1, -2, 4}, true},
    {"H", 1.0, {1, 2, -2}, true},
    {"Wb", 1.0, {1, 2, -2}, true},
};

struct Prefix {
  char letter;
  double factor;
};
constexpr Prefix k_prefixes[] = {{'n', 1e-9}, {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2}, {'d', 0.1}, {'k', 1e3}, {'M', 1e6}, {'G', 1e9}};

const Symbol* symbol_named(std::string_view name) {
  for (const Symbol& symbol : k_symbols)
    if (symbol.name == name) return &symbol;
  return nullptr;
}

std::optional<UnitDimension> of_symbol(std::string_view name) {
  if (const Symbol* symbol = symbol_named(name)) return UnitDimension{symbol->factor, symbol->powers};
  if (name.size() < 2) return std::nullopt;
  const Symbol* const symbol = symbol_named(name.substr(1));
  if (!symbol || !symbol->takes_prefix) return std::nullopt;
  for (const Prefix& prefix : k_prefixes)
    if (prefix.letter == name.front()) return UnitDimension{prefix.factor * symbol->factor, symbol->powers};
  return std::nullopt;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Splits "m^2", "m2" or "s-1" into symbol and exponent of at most two digits.
std::optional<UnitDimension> of_factor(std::string_view text) {
  std::size_t end = text.size();
  while (end > 0 && is_digit(text[end - 1])) --end;
  if (end == 0) return text == "1" ? of_symbol("1") : std::nullopt;
  int power = 1;
  if (end < text.size()) {
    if (text.size() - end > 2) return std::nullopt;
    power = 0;
    for (std::size_t i = end; i < text.size(); ++i) power = 10 * power + (text[i] - '0');
    if (text[end - 1] == '-') {
      power = -power;
      --end;
    }
    if (end > 0 && text[end - 1] == '^') --end;
  }
  std::optional<UnitDimension> unit = of_symbol(text.substr(0, end));
  if (!unit) return std::nullopt;
  UnitDimension raised;
  for (int i = 0; i < std::abs(power); ++i) raised.factor *= power > 0 ? unit->factor : 1.0 / unit->factor;
  for (std::size_t k = 0; k < 3; ++k) raised.powers[k] = power * unit->powers[k];
  return raised;
}

} // namespace

std::optional<UnitDimension> dimension_of(std::string_view unit) {
  UnitDimension product;
  const auto is_between = [](char c) { return c == ' ' || c == '.' || c == '*' || c == '/'; };
  bool divides = false, wants_factor = false;
  for (std::size_t i = 0; i < unit.size();) {
    if (is_between(unit[i])) {
      if (unit[i] == '/') {
        if (divides || (i == 0)) return std::nullopt;
        divides = wants_factor = true;
      }
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < unit.size() && !is_between(unit[end])) ++end;
    const std::optional<UnitDimension> factor = of_factor(unit.substr(i, end - i));
    if (!factor) return std::nullopt;
    product.factor = divides ? product.factor / factor->factor : product.factor * factor->factor;
    for (std::size_t k = 0; k < 3; ++k) product.powers[k] += divides ? -factor->powers[k] : factor->powers[k];
    divides = wants_factor = false;
    i = end;
  }
  if (wants_factor) return std::nullopt;
  return product;
}

std::string unit_text(const std::array<double, 3>& powers) {
  for (const char* usual : {"", "m", "s", "kg", "m/s", "m/s^2", "N", "W", "Pa", "N/m", "m^2", "1/s", "1/s^2", "kg m^2", "N s/m"})
    if (dimension_of(usual)->powers == powers) return usual;
  static constexpr const char* k_base[] = {"kg", "m", "s"};
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    if (powers[k] == 0.0) continue;
    text += (text.empty() ? "" : " ") + std::string(k_base[k]);
    if (powers[k] != 1.0) text += "^" + number_text(powers[k]);
  }
  return text;
}

} // namespace steplap
