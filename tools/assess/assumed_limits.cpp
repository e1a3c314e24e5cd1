#include "tools/assess/assumed_limits.h"

#include "mbd/io/presentation.h"
#include "transformer/core/uncertain.h"

#include <algorithm>
#include <optional>

namespace steplap::assess {

namespace {

constexpr const char* k_assumed = "assumed";

// Returns the indices of the parameters whose distribution is assumed.
std::vector<std::size_t> assumed_parameters(const Model& given) {
  constexpr std::string_view k_parameters = "parameters.";
  std::vector<std::size_t> found;
  for (const Uncertain* const uncertain : uncertain_of(given))
    for (const std::string& path : uncertain->paths)
      if (uncertain->source == k_assumed && path.starts_with(k_parameters))
        if (const auto parameter = given.parameters.find(path.substr(k_parameters.size()))) found.push_back(*parameter);
  return found;
}

} // namespace

std::vector<std::string> assumed_limits(const Model& given) {
  const std::vector<std::size_t> parameters = assumed_parameters(given);
  const auto depends_on_one = [&](const ParameterUse& use) {
    return std::any_of(parameters.begin(), parameters.end(), [&](std::size_t p) { return given.parameters.needs(use.formula, p); });
  };
  std::vector<std::string> names;
  for (const AcceptanceTable* const table : acceptance_tables_of(given)) {
    const std::string head = acceptance_kind().name + "." + table->name + ".";
    const auto& uses = given.parameters.uses;
    const bool follows =
        std::any_of(uses.begin(), uses.end(), [&](const ParameterUse& use) { return use.path.starts_with(head) && depends_on_one(use); });
    if (table->source == k_assumed || follows) names.push_back(table->name);
  }
  return names;
}

bool is_assumed(const std::vector<std::string>& assumed, const Model& model, const Judgement& judgement, std::size_t index) {
  // Criteria of elements come first and may have the same name, so only the last ones, those of the model, are compared.
  return index + model.criteria.size() >= judgement.criteria.size() &&
         std::find(assumed.begin(), assumed.end(), judgement.criteria[index].name) != assumed.end();
}

} // namespace steplap::assess
