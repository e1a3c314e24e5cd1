#include "tools/study/report_about.h"

#include "mbd/base/number_text.h"
#include "mbd/io/csv.h"
#include "tools/study/kinds.h"

#include <nlohmann/json.hpp>

#include <stdexcept>

namespace steplap::study {

namespace {

using Json = nlohmann::ordered_json;

// Returns "" for the unit "*", which stands for any unit.
std::string unit_or_none(const std::string& unit) { return unit == "*" ? "" : unit; }

std::string range_text(const Variable& v) {
  const std::string unit = unit_or_none(v.unit).empty() ? "" : " " + unit_or_none(v.unit);
  if (!v.range.empty()) return number_text(v.range[0]) + " to " + number_text(v.range[1]) + unit;
  std::string text;
  for (const double x : v.values) text += (text.empty() ? "" : ", ") + number_text(x);
  return text.empty() ? "kept" : text + unit;
}

bool is_sought_mean(const Variable& v) { return v.has_distribution() && (!v.range.empty() || !v.values.empty()); }

// Describes a distribution by its quantiles at fixed probabilities.
Json quantiles_of(const JointLaw& law, std::size_t place) {
  Json p = Json::array(), x = Json::array();
  constexpr int k_points = 100;
  const auto add = [&](double probability) {
    p.push_back(probability);
    x.push_back(law.quantile(place, probability));
  };
  for (const double tail : {0.001, 0.003, 0.006}) add(tail);
  for (int k = 1; k < k_points; ++k) add(static_cast<double>(k) / k_points);
  for (const double tail : {0.006, 0.003, 0.001}) add(1.0 - tail);
  return {{"p", std::move(p)}, {"x", std::move(x)}};
}

Json variable_json(const LoadedStudy& loaded, const JointLaw& law, std::size_t i) {
  const Variable& v = loaded.study.variables[i];
  Json json{{"name", v.name}, {"unit", unit_or_none(v.unit)}, {"paths", v.paths}, {"factor", v.is_factor}, {"model", v.model}};
  json["varies"] = range_text(v);
  const auto place = std::find(law.random().begin(), law.random().end(), i);
  if (v.has_distribution() && place != law.random().end()) {
    const auto k = static_cast<std::size_t>(place - law.random().begin());
    json["varies"] = is_sought_mean(v) ? law.text(k) + "; its mean is sought: " + range_text(v) : law.text(k);
    json["law"] = quantiles_of(law, k);
  }
  json["value"] = law.nominal()[i];
  if (v.range.size() == 2) json["range"] = v.range;
  return json;
}

std::string response_text(const Response& r) {
  if (!r.expression.empty()) return r.expression;
  std::string text = r.what;
  if (!r.channel.empty()) text += " of " + r.channel;
  if (!r.event.empty()) text += " of '" + r.event + "'";
  if (!r.element.empty()) text += " at " + r.element;
  return r.model.empty() ? text : text + ", " + r.model;
}

Json numbers_json(const LoadedStudy& loaded) {
  const Study& study = loaded.study;
  const std::vector<std::string> units = loaded.number_units();
  Json json = Json::array();
  for (const Response& r : study.responses)
    json.push_back({{"name", r.name}, {"unit", unit_or_none(units[json.size()])}, {"role", "response"}, {"is", response_text(r)}});
  for (const LimitState& l : study.limit_states)
    json.push_back({{"name", l.name}, {"unit", ""}, {"role", l.is_border ? "border" : "limit state"}, {"is", l.expression}});
  return json;
}

// Returns name, unit and channel of each measured record, for studies with such records.
template <class AnyStudy> Json history_count_json(const AnyStudy& study) {
  Json json = Json::array();
  if constexpr (requires { study.histories; })
    for (const auto& h : study.histories)
      json.push_back({{"name", h.name}, {"unit", unit_or_none(h.channel_unit)}, {"channel", h.channel}});
  return json;
}

Json value_json(const FieldValue& value) {
  return std::visit(
      []<class T>(const T& held) -> Json {
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string> || std::is_same_v<T, std::vector<std::string>>)
          return Json(held);
        else throw std::logic_error("a setting of a type that no page tells");
      },
      value);
}

Json settings_json(const Study& study) {
  const StudyKind& kind = kind_of(study);
  Json json = Json::object();
  for (const std::string& name : kind.shown) json[name] = value_json(kind.fields.find(name)->get(fields_of(*study.settings)));
  return json;
}

} // namespace

std::string about_of(const LoadedStudy& loaded, const JointLaw& law) {
  const Study& study = loaded.study;
  Json json{{"file", study.file}, {"title", study.title}, {"failed", study.failed}};
  json["variables"] = Json::array();
  for (std::size_t i = 0; i < study.variables.size(); ++i) json["variables"].push_back(variable_json(loaded, law, i));
  json["numbers"] = numbers_json(loaded);
  json["settings"] = settings_json(study);
  json["histories"] = history_count_json(study);
  json["models"] = Json::array();
  for (const auto& m : loaded.models) // load cases share the file of their model
    if (json["models"].empty() || json["models"].back() != m->path) json["models"].push_back(m->path);
  json["variants"] = Json::array();
  for (const ModelVariant& v : loaded.variants) json["variants"].push_back(v.name);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string variables_csv(const std::string& about) {
  const Json json = Json::parse(about);
  std::string text = "name,role,unit,is\n";
  const auto add = [&](const Json& entry, const std::string& role, const char* is) {
    const auto field = [&](const char* key) { return csv_field(entry.value(key, "")); };
    text += field("name") + "," + csv_field(role) + "," + field("unit") + "," + field(is) + "\n";
  };
  for (const Json& variable : json["variables"]) add(variable, "variable", "varies");
  for (const Json& number : json["numbers"]) add(number, number.value("role", ""), "is");
  return text;
}

} // namespace steplap::study
