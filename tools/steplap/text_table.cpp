#include "tools/steplap/text_table.h"

#include <algorithm>
#include <ostream>

namespace steplap {

namespace {

// UTF-8: continuation bytes take no room.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
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

} // namespace steplap
