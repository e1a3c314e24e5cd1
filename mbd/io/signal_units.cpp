#include "mbd/io/signal_units.h"

#include "mbd/io/column_unit.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/units.h"

namespace steplap {

namespace {

constexpr int k_deepest = 100; // nesting of signals; circular references are reported elsewhere

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

bool is_factor(const GivenField& given) { return given.field->name == "factor" || given.field->name == "factors"; }

} // namespace

// Returns the error in the unit of a value, or of the first wrong item of a list; "" if there is none.
std::string SignalUnits::problem_of(const Node& node, const std::string& unit) const {
  if (node.type == Node::Type::text) return problem_of_text(node, is_formula(node) ? parameters_.text_of(node) : node.text(), unit);
  std::string problem;
  for (const Node& item : node.children)
    if (problem.empty()) problem = problem_of(item, unit);
  return problem;
}

void SignalUnits::enter(const SignalEntry& entry, const std::vector<GivenField>& given) {
  signals_[entry.definition->name] = {&entry, &given};
}

std::string SignalUnits::misfit(const std::string& signal, const std::string& unit) const { return misfit(signal, unit, 0); }

std::string SignalUnits::misfit(const std::string& signal, const std::string& unit, int depth) const {
  const auto found = signals_.find(signal);
  if (found == signals_.end() || found->second.entry->kind->name == "product" || depth > k_deepest) return "";
  bool is_of_its_parts = true;
  for (const GivenField& given : *found->second.given) {
    if (!given.node || !given.is_usable) return "";
    is_of_its_parts = is_of_its_parts && !is_factor(given);
  }
  const std::string in_file = unit_of_file(*found->second.entry);
  const std::string own = in_file.empty() ? own_unit(found->second.entry->kind->name, *found->second.given) : in_file;
  if (!own.empty()) {
    const Quantity one = parse_quantity("1 " + own, unit);
    if (one.problem.empty()) return "";
    return "its signal '" + signal + "' is in " + own + (in_file.empty() ? "" : " by the header of its file") + ": " + one.problem;
  }
  for (const GivenField& given : *found->second.given) {
    const Field& field = *given.field;
    std::string problem;
    if (field.unit == "*" && !is_factor(given)) problem = problem_of(*given.node, unit);
    if (field.name == "unit" && field.type == FieldType::text && !given.node->text().empty()) // the unit of the values in a record
      problem = problem_of_text(*given.node, "1 " + given.node->text(), unit);
    if (!problem.empty()) return "its signal '" + signal + "' " + problem;
    if (!is_of_its_parts) continue;
    if (field.type == FieldType::signal) problem = misfit(given.node->text(), unit, depth + 1);
    if (field.type == FieldType::signals)
      for (const Node& part : given.node->children)
        if (problem.empty()) problem = misfit(part.text(), unit, depth + 1);
    if (!problem.empty()) return problem;
  }
  return "";
}

} // namespace steplap
