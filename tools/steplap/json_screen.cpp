#include "tools/steplap/json_screen.h"

#include "mbd/run/version.h"

#include <cmath>
#include <stdexcept>

namespace steplap {

namespace {

OrderedJson number_json(double value) { return std::isfinite(value) ? OrderedJson(value) : OrderedJson(); }

OrderedJson cell_json(const Cell& cell) {
  if (!cell.value) return cell.text;
  // Writes integers such as steps and counts without decimals.
  const double value = *cell.value;
  if (cell.unit.empty() && !cell.error)
    return value == std::floor(value) && std::abs(value) < 9e15 ? OrderedJson(static_cast<long>(value)) : number_json(value);
  OrderedJson json{{"value", number_json(value)}, {"unit", cell.unit}};
  if (cell.error) json["error"] = number_json(*cell.error);
  return json;
}

OrderedJson table_json(const TextTable& table) {
  const std::vector<std::string>& keys = table.keys();
  if (keys.empty()) {
    OrderedJson pairs = OrderedJson::object();
    for (const TextTable::Row& row : table.rows()) pairs[row[0].text] = row.size() > 1 ? cell_json(row[1]) : OrderedJson();
    return pairs;
  }
  OrderedJson rows = OrderedJson::array();
  for (std::size_t i = 1; i < table.rows().size(); ++i) {
    OrderedJson row = OrderedJson::object();
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (!keys[k].empty()) row[keys[k]] = cell_json(table.rows()[i][k]);
    rows.push_back(std::move(row));
  }
  return rows;
}

} // namespace

OrderedJson& JsonScreen::result() {
  if (results_.empty()) results_.push_back(OrderedJson::object());
  return results_.back();
}

void JsonScreen::keep_text() {
  std::istringstream lines(str());
  str("");
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin != std::string::npos) result()["text"].push_back(line.substr(begin));
  }
}

void JsonScreen::begin(const About& about) {
  keep_text();
  results_.push_back(OrderedJson::object());
  results_.back()["about"] = about.subject;
}

void JsonScreen::take(const TextTable& table) {
  keep_text();
  if (table.rows().empty()) return;
  if (table.name().empty()) throw std::logic_error("a table of this command has no name for --json");
  OrderedJson& tables = result()["tables"];
  if (tables.contains(table.name())) throw std::logic_error("two tables of one result are called '" + table.name() + "'");
  tables[table.name()] = table_json(table);
}

void JsonScreen::put(const std::string& name, OrderedJson document) {
  keep_text();
  result()[name] = std::move(document);
}

std::string JsonScreen::document(const std::string& program, const std::string& command, int exit_code) {
  keep_text();
  const OrderedJson whole{
      {"program", program}, {"version", k_version}, {"command", command}, {"results", results_}, {"exit_code", exit_code}};
  return whole.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

JsonScreen* json_screen(std::ostream& stream) { return dynamic_cast<JsonScreen*>(&stream); }

} // namespace steplap
