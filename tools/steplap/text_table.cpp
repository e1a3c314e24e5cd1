#include "tools/steplap/text_table.h"

#include "mbd/run/quantity_text.h"
#include "tools/steplap/text_layout.h"

#include <algorithm>
#include <ostream>

namespace steplap {

Cell quantity_cell(double value, const std::string& unit) { return {quantity_text(value, unit), value, unit}; }

Cell quantity_cell(double value, const std::string& unit, double scale) { return {quantity_text(value, unit, scale), value, unit}; }

Cell count_cell(std::size_t count) { return {std::to_string(count), static_cast<double>(count)}; }

TextTable::TextTable(std::vector<Align> columns, int indent) : columns_(std::move(columns)), indent_(indent) {}

void TextTable::set_head(std::string name, const std::vector<std::string>& heads, std::vector<std::string> keys) {
  name_ = std::move(name);
  keys_ = keys.empty() ? heads : std::move(keys);
  add_row(Row(heads.begin(), heads.end()));
}

void TextTable::add_row(Row cells) {
  cells.resize(columns_.size(), Cell(""));
  rows_.push_back(std::move(cells));
}

namespace {

// Returns the stream's sink for tables; null if it shows text.
TableSink* sink_of(std::ostream& stream) { return dynamic_cast<TableSink*>(&stream); }

} // namespace

std::ostream& operator<<(std::ostream& stream, const TextTable& table) {
  if (TableSink* const sink = sink_of(stream)) {
    sink->take(table);
    return stream;
  }
  std::vector<std::size_t> widths(table.columns_.size(), 0);
  for (const auto& row : table.rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i].text));
  for (const auto& row : table.rows_) {
    std::string line(static_cast<std::size_t>(table.indent_), ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string gap(widths[i] - width_of(row[i].text), ' ');
      line += table.columns_[i] == TextTable::Align::left ? row[i].text + gap : gap + row[i].text;
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    stream << line << '\n';
  }
  return stream;
}

std::ostream& operator<<(std::ostream& stream, const About& about) {
  if (TableSink* const sink = sink_of(stream)) sink->begin(about);
  return stream;
}

} // namespace steplap
