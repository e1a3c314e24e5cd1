#include "mbd/io/signal_units.h"

#include "mbd/io/column_unit.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/units.h"
#include "mbd/model/signal_use.h"

#include <algorithm>

namespace steplap {

namespace {

bool has_unit(const std::string& text) { return text.find_first_not_of("0123456789.+-eE \t\r\n") != std::string::npos; }

std::string problem_of_text(const Node& node, const std::string& text, const std::string& unit) {
  if (!has_unit(text)) return "";
  const Quantity quantity = parse_quantity(text, unit);
  return quantity.problem.empty() ? "" : "(line " + std::to_string(node.line) + "): " + quantity.problem;
}

// Returns the unit of a signal whose kind determines it; "" for other kinds.
std::string own_unit(const std::string& kind, const std::vector<GivenField>& given) {
  if (kind == "road") return "m";
  if (kind == "recorder") return "m/s^2";
  if (kind != "sea") return "";
  for (const GivenField& each : given)
    if (each.field->name == "component") return each.node->text() == "angle" ? "rad" : each.node->text() == "height" ? "m" : "m/s^2";
  return "";
}

std::string text_of(const SignalEntry& entry, const char* field) {
  return std::get<std::string>(entry.kind->fields.find(field)->get(entry.definition.get()));
}

// Returns the unit that the file of a record states; "" for other signals, and if the model gives the unit.
std::string unit_of_file(const SignalEntry& entry) {
  if (entry.kind->name != "record" || !text_of(entry, "unit").empty()) return "";
  return unit_in_file(text_of(entry, "file"), text_of(entry, "column"));
}

// Returns true for factors that the file gives: numbers other than 1, and all with a unit.
bool may_change_unit(const GivenField& given) {
  if (!given.node || !is_factor(*given.field)) return false;
  const auto is_one = [](const Node& node) {
    return (node.type == Node::Type::integer && std::get<long>(node.scalar) == 1) ||
           (node.type == Node::Type::number && std::get<double>(node.scalar) == 1.0);
  };
  const std::vector<Node>& items = given.node->children;
  return given.node->type == Node::Type::array ? !std::all_of(items.begin(), items.end(), is_one) : !is_one(*given.node);
}

} // namespace

// Returns the error in the unit of a value, or of the first wrong item of a list; "" if there is none.
std::string SignalUnits::problem_of(const Node& node, const std::string& unit) const {
  if (node.type == Node::Type::text) return problem_of_text(node, is_formula(node) ? parameters_.text_of(node) : node.text(), unit);
  std::string problem;
  for (const Node& item : node.children)
    if (problem.empty()) problem = problem_of(item, unit);
  return problem;
}

std::string SignalUnits::misfit(const std::string& signal, const std::string& unit) const {
  const auto has_factors = [this](const SignalEntry& entry) {
    const std::vector<GivenField>& given = *given_.at(&entry);
    return std::any_of(given.begin(), given.end(), may_change_unit);
  };
  for (const SignalEntry* entry : signals_in_unit_of(model_, signal, has_factors))
    if (const std::string problem = misfit_of(*entry, unit); !problem.empty())
      return "its signal '" + entry->definition->name + "' " + problem;
  return "";
}

// Returns the problem with the signal's own values.
std::string SignalUnits::misfit_of(const SignalEntry& entry, const std::string& unit) const {
  const std::vector<GivenField>& all = *given_.at(&entry);
  if (std::any_of(all.begin(), all.end(), [](const GivenField& given) { return !given.node || !given.is_usable; })) return "";
  const std::string in_file = unit_of_file(entry);
  const std::string own = in_file.empty() ? own_unit(entry.kind->name, all) : in_file;
  if (!own.empty()) {
    const Quantity one = parse_quantity("1 " + own, unit);
    return one.problem.empty() ? "" : "is in " + own + (in_file.empty() ? "" : " by the header of its file") + ": " + one.problem;
  }
  for (const GivenField& given : all) {
    const Field& field = *given.field;
    std::string problem;
    if (is_in_unit_of_signal(*entry.kind, field)) problem = problem_of(*given.node, unit);
    if (field.name == "unit" && field.type == FieldType::text && !given.node->text().empty()) // the unit of the values in a record
      problem = problem_of_text(*given.node, "1 " + given.node->text(), unit);
    if (!problem.empty()) return problem;
  }
  return "";
}

} // namespace steplap
