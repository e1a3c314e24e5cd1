#include "mbd/model/parameters.h"

#include "mbd/base/number_text.h"
#include "mbd/formula/unit_dimension.h"

#include <algorithm>
#include <cmath>

namespace steplap {

double ParameterFormula::value(const std::vector<double>& values) const {
  std::vector<double> operands;
  operands.reserve(of.size());
  for (const std::size_t parameter : of) operands.push_back(values[parameter]);
  std::vector<double> nodes(formula.tree().size());
  return value_of(formula.tree(), operands.data(), 0.0, nodes.data());
}

std::optional<std::size_t> Parameters::find(const std::string& name) const {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Parameter& p) { return p.name == name; });
  if (found == entries.end()) return std::nullopt;
  return static_cast<std::size_t>(found - entries.begin());
}

bool Parameters::needs(const ParameterFormula& formula, std::size_t parameter) const {
  std::vector<bool> is_seen(entries.size(), false); // each parameter is visited once, however many formulas use it
  std::vector<std::size_t> waiting = formula.of;
  while (!waiting.empty()) {
    const std::size_t k = waiting.back();
    waiting.pop_back();
    if (k == parameter) return true;
    if (is_seen[k]) continue;
    is_seen[k] = true;
    if (entries[k].formula) waiting.insert(waiting.end(), entries[k].formula->of.begin(), entries[k].formula->of.end());
  }
  return false;
}

std::string problem_with(const Parameter& parameter, double value) {
  if (!std::isfinite(value)) return "parameter '" + parameter.name + "' has no finite value";
  const auto shown = [&](double bound) {
    const std::string unit = unit_text(parameter.powers);
    return number_text(bound) + (unit.empty() ? "" : " " + unit);
  };
  if (parameter.least && value < *parameter.least)
    return "parameter '" + parameter.name + "' is " + shown(value) + ", below its range, which begins at " + shown(*parameter.least);
  if (parameter.most && value > *parameter.most)
    return "parameter '" + parameter.name + "' is " + shown(value) + ", above its range, which ends at " + shown(*parameter.most);
  return "";
}

void Parameters::evaluate() {
  for (const std::size_t k : order) values[k] = entries[k].formula->value(values);
}

} // namespace steplap
