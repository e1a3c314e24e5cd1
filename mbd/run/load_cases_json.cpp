#include "mbd/run/load_cases.h"
#include "mbd/run/summary.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace steplap {

namespace {

OrderedJson number(const std::optional<double>& value) { return value && std::isfinite(*value) ? OrderedJson(*value) : OrderedJson(); }

OrderedJson limit_json(const CaseLimit& limit) {
  OrderedJson json{{"limit", limit.name},
                   {"outcome", name_of(limit.result.outcome)},
                   {"utilisation", number(limit.share)},
                   {"margin", number(limit.result.reserve)},
                   {"unit", limit.result.unit}};
  if (limit.share_error) json["utilisation_error"] = number(limit.share_error); // null if the error is unknown
  return json;
}

OrderedJson case_json(const CaseResult& one) {
  const CaseLimit* const governing = one.governing();
  OrderedJson json{{"name", one.load.name},
                   {"plane", one.load.plane},
                   {"source", one.load.source},
                   {"overrides", one.overrides},
                   {"verdict", name_of(one.judgement.verdict)},
                   {"reason", one.reason},
                   {"governing_limit", governing ? OrderedJson(governing->name) : OrderedJson()},
                   {"limits", OrderedJson::array()},
                   {"judgement", judgement_json(one.judgement)}};
  if (!one.failure.empty()) json["failure"] = one.failure;
  for (const CaseLimit& limit : one.limits) json["limits"].push_back(limit_json(limit));
  return json;
}

} // namespace

OrderedJson load_cases_document(const LoadCaseResults& results) {
  OrderedJson json{{"model", model_json(*results.models.front())},
                   {"verdict", name_of(results.verdict())},
                   {"reason", results.reason()},
                   {"cases", OrderedJson::array()},
                   {"limits", OrderedJson::array()}};
  for (std::size_t i = 1; i < results.models.size(); ++i) json["other_planes"].push_back(model_json(*results.models[i]));
  for (const CaseResult& one : results.cases) json["cases"].push_back(case_json(one));
  for (const LimitRow& row : limit_rows(results))
    json["limits"].push_back({{"limit", row.name}, {"governing_case", results.cases[row.governing].load.name}});
  return json;
}

} // namespace steplap
