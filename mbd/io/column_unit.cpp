#include "mbd/io/column_unit.h"

#include "mbd/io/units.h"

#include <cmath>

namespace steplap {

namespace {

Quantity one(const std::string& unit, const std::string& wanted) { return parse_quantity("1 " + unit, wanted); }

// Returns the unit as parse_quantity() reads it; "" for "-".
std::string readable(const std::string& text, const std::string& wanted) {
  if (text == "-") return "";
  return wanted != "s" && wanted != "kg" && (text == "g" || text == "G") ? "gravity" : text;
}

std::string advice(const ColumnUnit& unit) {
  return unit.key.empty() ? "give it in brackets, as [kPa], or leave it out for SI" : "give it by '" + unit.key + "'";
}

// Refuses a column such as "force (kN)": parentheses may hold a unit or a part of the name.
void refuse_unit_in_parentheses(const ColumnUnit& unit, const std::string& name) {
  const std::size_t open = name.rfind('(');
  if (open == std::string::npos || name.back() != ')') return;
  const Quantity found = one(readable(name.substr(open + 1, name.size() - open - 2), unit.wanted), unit.wanted);
  if (found.problem.empty() && found.value != 1.0)
    throw ModelError(unit.where, unit.owner + ": column '" + name + "' may be in the unit in its parentheses: " +
                                     (unit.key.empty() ? advice(unit) : "say which by '" + unit.key + "'"));
}

} // namespace

std::string unit_in_header(const CsvTable& table, std::size_t column, const std::string& wanted) {
  return table.units.empty() ? "" : readable(table.units[column], wanted);
}

UnitConversion conversion_of(const CsvTable& table, std::size_t column, const ColumnUnit& unit) {
  constexpr double k_same = 1e-9; // two spellings of one unit may differ by rounding
  const std::string in_header = table.units.empty() ? std::string() : table.units[column];
  const std::string header = unit_in_header(table, column, unit.wanted), &used = unit.given.empty() ? header : unit.given;
  if (used.empty() && !table.names.empty()) refuse_unit_in_parentheses(unit, table.names[column]);
  if (used.empty()) return {};
  if (!unit.given.empty() && !header.empty() && one(header, unit.wanted).problem.empty())
    if (const Quantity ratio = one(unit.given, header); !ratio.problem.empty() || !(std::abs(ratio.value - 1.0) <= k_same))
      throw ModelError(unit.where, "'" + unit.key + "' of " + unit.owner + " is '" + unit.given + "', but the column says [" + in_header +
                                       "]: drop '" + unit.key + "', or correct the file");
  const Quantity zero = parse_quantity("0 " + used, unit.wanted), factor = one(used, unit.wanted);
  if (!factor.problem.empty() && unit.given.empty())
    throw ModelError(unit.where,
                     "the column's unit [" + in_header + "] of " + unit.owner + " is not known" +
                         (unit.wanted.empty() || unit.wanted == "*" ? "" : ", or of another quantity than '" + unit.wanted + "'") + ": " +
                         advice(unit));
  if (!factor.problem.empty()) throw ModelError(unit.where, "'" + unit.key + "' of " + unit.owner + ": " + factor.problem);
  return {factor.value - zero.value, zero.value};
}

std::string unit_in_file(const std::string& path, const std::string& column) {
  const CsvTable table = read_csv_header(path);
  if (table.units.empty()) return "";
  std::size_t place = 0;
  try {
    place = table.column(column, {});
  } catch (const ModelError&) {
    return "";
  }
  const std::string unit = unit_in_header(table, place, "*");
  return unit.empty() || !one(unit, "*").problem.empty() ? "" : unit;
}

} // namespace steplap
