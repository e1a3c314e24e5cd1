#include "mbd/io/parameters_reader.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/model_path.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

namespace steplap {

namespace {

// Returns true if the text is a valid name of a parameter. For a part's parameter, such as "wagon 2.wall", the text after the names of
// parts is checked.
bool is_name(const std::string& whole) {
  if (whole.find_first_of("{}[]") != std::string::npos) return false;
  const std::string text = whole.substr(whole.rfind('.') + 1);
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 && std::all_of(text.begin(), text.end(), is_letter) &&
         text != "pi" && text != "t";
}

std::string without_sign(const Node& node) {
  const std::string text = node.text();
  return text.substr(text.find('=') + 1);
}

bool uses_time(const Formula& formula) {
  return std::any_of(formula.tree().begin(), formula.tree().end(), [](const FormulaNode& node) { return node.op == FormulaOp::time; });
}

std::string said(const std::array<double, 3>& powers) {
  const std::string unit = unit_text(powers);
  return unit.empty() ? "a number without a unit" : "a value in " + unit;
}

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

// Calls visit(node, path, likeness) for every value of the document. `path` is the value's path as in model_path.h. `likeness` is a text
// that is equal for the same field in entries of the same kind.
class Walk {
public:
  using Visit = std::function<void(const Node&, const std::string&, const std::string&)>;
  Walk(const Node& root, Visit visit) : visit_(std::move(visit)) {
    for (const Node& child : root.children) {
      if (child.is_array_of_tables())
        for (const Node& entry : child.children) in_entry(entry, child.key);
      else in_value(child, child.key, child.key, "");
    }
  }

private:
  void in_entry(const Node& entry, const std::string& array) {
    const std::string name = entry_name(entry);
    const Node* const kind = entry.find("kind");
    const std::string alike = array + " " + (kind ? kind->text() : "") + " ";
    for (const Node& child : entry.children)
      in_value(child, array + "." + name + "." + child.key, alike + child.key, array == "element" ? name + "." + child.key : "");
  }

  // Visits one value with all values inside. If `marker` is not empty, an inline table is a marker with this name.
  void in_value(const Node& node, const std::string& path, const std::string& alike, const std::string& marker) {
    if (node.is_table()) {
      const std::string own = entry_name(node);
      const std::string base = marker.empty() ? path : "marker." + (own.empty() ? marker : own);
      for (const Node& child : node.children)
        in_value(child, base + "." + child.key, (marker.empty() ? alike : "marker") + "." + child.key, "");
    } else if (node.type == Node::Type::array) {
      for (std::size_t i = 0; i < node.children.size(); ++i)
        in_value(node.children[i], path + "." + std::to_string(i), alike + "." + std::to_string(i), "");
    } else {
      visit_(node, path, alike);
    }
  }

  Visit visit_;
};

bool can_be_set(const Model& model, const std::string& path) {
  try {
    static_cast<void>(value_of(model, path));
    return true;
  } catch (const ModelError&) {
    return false;
  }
}

} // namespace

bool is_formula(const Node& node) {
  const std::string text = node.text();
  const std::size_t first = text.find_first_not_of(" \t");
  return first != std::string::npos && text[first] == '=';
}

ParametersReader::ParametersReader(const Node& root, std::vector<Diagnostic>& problems) : problems_(problems) {
  const Node* table = root.find("parameters");
  if (!table) return;
  if (!table->is_table()) {
    add(table->where_key(), std::string("'parameters' must be a table, [parameters], not ") + table->type_name());
    return;
  }
  for (const Node& entry : table->children) read_entry(entry);
  is_resolved_.resize(parameters_.entries.size());
  // Formulas are read after all names are known, since they may refer to later parameters.
  for (std::size_t i = 0; i < parameters_.entries.size(); ++i) {
    Parameter& parameter = parameters_.entries[i];
    if (is_wrong_[i] || parameter.text.empty() || parameter.text.front() != '=') continue;
    try {
      parameter.formula = formula_of(parameter.text.substr(1), parameter.where);
    } catch (const ModelError& error) {
      add(parameter.where, "parameter '" + parameter.name + "': " + error.diagnostics().front().message);
      is_wrong_[i] = true;
    }
  }
  for (std::size_t i = 0; i < parameters_.entries.size(); ++i) {
    std::vector<std::size_t> chain;
    resolve(i, chain);
  }
  check_ranges();
}

void ParametersReader::read_entry(const Node& entry) {
  Parameter parameter;
  parameter.name = entry.key;
  parameter.where = entry.where();
  double value = 0.0;
  const std::size_t before = problems_.size();
  turns_.push_back(AngleUnit::none);
  if (!is_name(entry.key))
    add(entry.where_key(),
        "a parameter's name has letters, digits and _, does not begin with a digit, and is neither 'pi' nor 't'; got '" + entry.key + "'");
  if (entry.is_table()) {
    const Node* given = entry.find("value");
    if (given) {
      parameter.where = given->where();
      read_value(*given, parameter, value);
    } else {
      add(entry.where(), "parameter '" + entry.key + "' needs 'value'");
    }
    for (const Node& child : entry.children) {
      if (child.key == "value" || child.key == "range") continue;
      if (child.key == "meaning" && child.type == Node::Type::text) parameter.meaning = child.text();
      else if (child.key == "meaning")
        add(child.where(), "'meaning' of parameter '" + entry.key + "': expected a string, got " + child.type_name());
      else
        add(child.where_key(),
            "unknown key '" + child.key + "' in parameter '" + entry.key + "'" + did_you_mean(child.key, {"value", "range", "meaning"}));
    }
    if (const Node* range = entry.find("range"); range && problems_.size() == before) read_range(*range, parameter);
  } else {
    read_value(entry, parameter, value);
  }
  is_wrong_.push_back(problems_.size() != before);
  if (!by_name_.emplace(parameter.name, parameters_.entries.size()).second) {
    add(entry.where_key(), "a parameter named '" + parameter.name + "' exists already: choose another name");
    is_wrong_.back() = true;
  }
  parameters_.entries.push_back(std::move(parameter));
  parameters_.values.push_back(value);
}

void ParametersReader::read_value(const Node& node, Parameter& parameter, double& value) {
  const auto complain = [&](const std::string& message) { add(node.where(), "parameter '" + parameter.name + "': " + message); };
  if (node.type == Node::Type::integer || node.type == Node::Type::number) {
    value = node.type == Node::Type::integer ? static_cast<double>(std::get<long>(node.scalar)) : std::get<double>(node.scalar);
    parameter.text = number_text(value);
    if (!std::isfinite(value)) complain("must be finite");
    return;
  }
  if (node.type != Node::Type::text)
    return complain(std::string("expected a number, a text such as \"12 mm\" or a formula such as \"= 2*wall\", got ") + node.type_name());
  if (is_formula(node)) {
    parameter.text = "=" + without_sign(node);
    return;
  }
  parameter.text = node.text();
  const Quantity quantity = parse_quantity(node.text(), "*");
  if (!quantity.problem.empty()) return complain(quantity.problem);
  const std::optional<std::array<double, 3>> powers = powers_in(node.text());
  if (!powers) return complain("'" + node.text() + "' has a unit that is not made of kg, m and s");
  value = quantity.value;
  parameter.powers = *powers;
  if (*powers != std::array<double, 3>{0.0, 0.0, -1.0}) return;
  if (contains(parameter.text, "rad") || contains(parameter.text, "rpm") || contains(parameter.text, "rev") ||
      contains(parameter.text, "deg"))
    turns_.back() = AngleUnit::radians;
  else if (!parse_quantity(parameter.text, "rad/s").problem.empty()) turns_.back() = AngleUnit::turns; // "Hz" and "1/min"
}

// Reads a range. Its ends must have the unit of the parameter's value, which check_ranges() checks later.
void ParametersReader::read_range(const Node& range, Parameter& parameter) {
  const auto complain = [&](const Node& at, const std::string& message) {
    add(at.where(), "'range' of parameter '" + parameter.name + "': " + message);
  };
  if (range.type != Node::Type::array || range.children.size() != 2) return complain(range, "expected [least, most]");
  std::optional<double>* const ends[] = {&parameter.least, &parameter.most};
  for (std::size_t i = 0; i < 2; ++i) {
    const Node& end = range.children[i];
    Parameter read;
    read.name = parameter.name;
    double value = 0.0;
    const std::size_t before = problems_.size();
    const AngleUnit turns = turns_.back();
    read_value(end, read, value);
    turns_.back() = turns;
    if (problems_.size() != before) return;
    if (is_formula(end)) return complain(end, "its ends are numbers, not formulas");
    const bool is_given_as_formula = parameter.text.starts_with('=');
    const bool is_overridden = parameter.where.line == 0 && end.where().line != 0; // then the value is wrong, not the range of the file
    if (!is_given_as_formula && read.powers != parameter.powers && is_overridden)
      return add(parameter.where, "parameter '" + parameter.name + "' is " + said(parameter.powers) + ", its range '" + read.text + "' " +
                                      said(read.powers));
    if (!is_given_as_formula && read.powers != parameter.powers)
      return complain(end, "'" + read.text + "' is " + said(read.powers) + ", the parameter " + said(parameter.powers));
    *ends[i] = value;
  }
  if (*parameter.least > *parameter.most) complain(range, "begins above its end");
}

ParameterFormula ParametersReader::formula_of(const std::string& text, const Location& where) const {
  ParameterFormula made{Formula(text, "formula", where), {}};
  if (uses_time(made.formula)) throw ModelError(where, "formula: 't' is the time, and parameters do not change with it");
  for (const std::string& name : made.formula.names()) {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) {
      std::vector<std::string> known;
      for (const Parameter& parameter : parameters_.entries) known.push_back(parameter.name);
      throw ModelError(where, "formula: there is no parameter '" + name + "'" + did_you_mean(name, known));
    }
    made.of.push_back(found->second);
  }
  return made;
}

std::array<double, 3> ParametersReader::dimension_exponents(const ParameterFormula& formula) const {
  std::vector<std::string> units;
  for (const std::size_t k : formula.of) units.push_back(unit_text(parameters_.entries[k].powers));
  return formula.formula.dimension(units).powers;
}

// Evaluates the formula of a parameter, after those of the parameters that it uses. Returns false if one of them is invalid.
bool ParametersReader::resolve(std::size_t index, std::vector<std::size_t>& chain) {
  Parameter& parameter = parameters_.entries[index];
  if (is_wrong_[index]) return false;
  if (is_resolved_[index] || !parameter.formula) return is_resolved_[index] = true;
  if (const auto begin = std::find(chain.begin(), chain.end(), index); begin != chain.end()) {
    std::string ring;
    for (auto k = begin; k != chain.end(); ++k) ring += parameters_.entries[*k].name + " -> ";
    add(parameter.where, "parameters that need each other: " + ring + parameter.name);
    for (auto k = begin; k != chain.end(); ++k) is_wrong_[*k] = true;
    return false;
  }
  chain.push_back(index);
  bool is_known = true;
  for (const std::size_t k : parameter.formula->of) is_known = resolve(k, chain) && is_known;
  chain.pop_back();
  if (!is_known || is_wrong_[index]) {
    is_wrong_[index] = true;
    return false;
  }
  for (const std::size_t k : parameter.formula->of)
    if (turns_[k] != AngleUnit::none) turns_[index] = turns_[k];
  try {
    parameter.powers = dimension_exponents(*parameter.formula);
    parameters_.values[index] = parameter.formula->value(parameters_.values);
    if (!std::isfinite(parameters_.values[index])) throw ModelError(parameter.where, "the formula has no finite value");
  } catch (const ModelError& error) {
    add(parameter.where, "parameter '" + parameter.name + "': " + error.diagnostics().front().message);
    is_wrong_[index] = true;
    return false;
  }
  parameters_.order.push_back(index);
  return is_resolved_[index] = true;
}

void ParametersReader::check_ranges() {
  for (std::size_t i = 0; i < parameters_.entries.size(); ++i) {
    if (is_wrong_[i]) continue;
    const std::string problem = problem_with(parameters_.entries[i], parameters_.values[i]);
    if (!problem.empty()) add(parameters_.entries[i].where, problem);
  }
}

// Returns an error if the formula mixes turns and radians: both are 1/s, but 10 rad/s is not a frequency of 10 Hz. "" if it does not.
std::string ParametersReader::turns_problem(const ParameterFormula& formula, const std::string& unit) const {
  const AngleUnit wanted = unit == "Hz" ? AngleUnit::turns : unit == "rad/s" ? AngleUnit::radians : AngleUnit::none;
  if (wanted == AngleUnit::none) return "";
  for (const std::size_t k : formula.of) {
    if (turns_[k] == AngleUnit::none || turns_[k] == wanted) continue;
    const Parameter& parameter = parameters_.entries[k];
    return "parameter '" + parameter.name + "' counts " + (wanted == AngleUnit::turns ? "radians" : "turns") + " a second, but the field " +
           (wanted == AngleUnit::turns ? "turns, 'Hz'" : "radians, 'rad/s'") +
           ": write the parameter in 1/s, and 2*pi in the formula where it belongs";
  }
  return "";
}

Quantity ParametersReader::value(const Node& node, const std::string& unit) {
  is_excused_ = false;
  try {
    Found found{{"", node.text(), "", formula_of(without_sign(node), node.where()), node.where()}, 0.0};
    const ParameterFormula& formula = found.use.formula;
    if (std::any_of(formula.of.begin(), formula.of.end(), [&](std::size_t k) { return is_wrong_[k]; })) {
      is_excused_ = true;
      return {};
    }
    const std::array<double, 3> powers = dimension_exponents(formula);
    found.use.unit = unit_text(powers);
    found.value = formula.value(parameters_.values);
    if (!std::isfinite(found.value)) return {0.0, "the formula '" + node.text() + "' has no finite value"};
    if (std::string problem = turns_problem(formula, unit); !problem.empty()) return {0.0, std::move(problem)};
    const std::optional<UnitDimension> wanted = dimension_of(unit);
    if (unit != "*" && wanted && wanted->powers != powers)
      return {0.0, "the formula gives " + said(powers) + ", but " +
                       (unit.empty() ? "a number without a unit" : "a unit like '" + unit + "'") + " is needed"};
    if (unit != "*" && !wanted) { // a unit that formulas do not know
      const Quantity converted = parse_quantity(number_text(found.value) + " " + found.use.unit, unit);
      if (!converted.problem.empty()) return converted;
    }
    const double result = found.value;
    found_.insert_or_assign(&node, std::move(found));
    return {result, ""};
  } catch (const ModelError& error) {
    return {0.0, error.diagnostics().front().message};
  }
}

std::string ParametersReader::text_of(const Node& node) const {
  const auto found = found_.find(&node);
  if (found == found_.end()) return "";
  const std::string& unit = found->second.use.unit;
  return number_text(found->second.value) + (unit.empty() ? "" : " " + unit);
}

Parameters ParametersReader::parameters(const Node& root, const Model& model) const {
  Parameters result = parameters_;
  if (found_.empty()) return result;
  // Whether a field can be set by path is determined once for all entries of a kind, because finding an entry by its name is slow in large
  // models.
  std::unordered_map<std::string, bool> settable;
  const Walk walk(root, [&](const Node& node, const std::string& path, const std::string& alike) {
    const auto found = found_.find(&node);
    if (found == found_.end()) return;
    ParameterUse& use = result.uses.emplace_back(found->second.use);
    use.path = path;
    const auto [known, is_new] = settable.emplace(alike, false);
    if (is_new) known->second = can_be_set(model, path);
    use.can_be_set = known->second;
  });
  return result;
}

} // namespace steplap
