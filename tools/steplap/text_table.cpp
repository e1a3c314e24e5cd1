#include "tools/steplap/text_table.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace steplap {

namespace {

constexpr double k_rounding = 1e-9;

// UTF-8: continuation bytes take no room.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string formatted(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

} // namespace

TextTable::TextTable(std::vector<Align> columns, int indent)
    : columns_(std::move(columns)), indent_(indent) {}

void TextTable::add_row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::ostream& operator<<(std::ostream& stream, const TextTable& table) {
  std::vector<std::size_t> widths(table.columns_.size(), 0);
  for (const auto& row : table.rows_)
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], width_of(row[i]));
  for (const auto& row : table.rows_) {
    std::string line(static_cast<std::size_t>(table.indent_), ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string gap(widths[i] - width_of(row[i]), ' ');
      line += table.columns_[i] == TextTable::Align::left ? row[i] + gap : gap + row[i];
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    stream << line << '\n';
  }
  return stream;
}

bool takes_prefix(const std::string& unit) {
  return unit == "N" || unit == "N m" || unit == "J" || unit == "Pa" || unit == "m" || unit == "rad";
}

// Metres are read in millimetres here: steps and gaps, not lengths of machines.
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
  return quantity_text(std::abs(value) < k_rounding * std::abs(scale) ? 0.0 : value, unit);
}

std::string time_text(double t) {
  return formatted("%.6f", t);
}

std::string small_text(double value) {
  return formatted("%.2g", value);
}

} // namespace steplap
