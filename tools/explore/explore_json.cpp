#include "tools/explore/explore_json.h"

#include "mbd/run/summary.h"
#include "mbd/run/version.h"
#include "tools/explore/run_results.h"
#include "tools/pages/report_data.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <stdexcept>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_most_values = 200; ///< largest number of values in one request

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("The request is not one that the page sends: " + what + ".");
}

Json parsed(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) refuse("it is no JSON object");
  return json;
}

const Json& member(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end()) refuse(std::string("'") + name + "' is missing");
  return *found;
}

std::string text_member(const Json& json, const char* name) {
  const Json& value = member(json, name);
  if (!value.is_string() || value.get_ref<const std::string&>().size() > 1000) refuse(std::string("'") + name + "' is no short text");
  return value.get<std::string>();
}

std::size_t model_of(const Json& json, std::size_t models) {
  const Json& value = member(json, "model");
  if (!value.is_number_unsigned() || value.get<std::size_t>() >= models) refuse("'model' is none of the models");
  return value.get<std::size_t>();
}

ExploredValues values_of(const Json& json) {
  const Json& given = member(json, "values");
  if (!given.is_object() || given.size() > k_most_values) refuse("'values' is no object of numbers");
  ExploredValues values;
  for (const auto& [path, value] : given.items()) {
    if (!value.is_number()) refuse("'values' holds what is no number");
    values[path] = value.get<double>();
  }
  return values;
}

Json error_json(const Diagnostic& problem) {
  return {{"file", problem.where.file}, {"line", problem.where.line}, {"column", problem.where.column}, {"message", problem.message}};
}

// Decodes "%7B" to '{'.
std::string without_escapes(const std::string& text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    const std::string digits = text.substr(i + 1, 2);
    if (digits.size() < 2 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) refuse("its address is cut off");
    plain += static_cast<char>(std::stoi(digits, nullptr, 16));
    i += 2;
  }
  return plain;
}

} // namespace

RunRequest run_request(const std::string& body, std::size_t models) {
  const Json json = parsed(body);
  RunRequest asked;
  asked.model = model_of(json, models);
  asked.values = values_of(json);
  if (json.contains("page")) asked.page = text_member(json, "page");
  if (json.contains("name")) asked.name = text_member(json, "name");
  if (json.contains("is_settled")) {
    if (!json["is_settled"].is_boolean()) refuse("'is_settled' is neither true nor false");
    asked.is_settled = json["is_settled"].get<bool>();
  }
  return asked;
}

MapRequest map_request(const std::string& body, std::size_t models, std::size_t most_cells) {
  const Json json = parsed(body);
  MapRequest asked;
  asked.model = model_of(json, models);
  asked.values = values_of(json);
  asked.x = text_member(json, "x");
  asked.y = text_member(json, "y");
  const Json& cells = member(json, "cells");
  if (!cells.is_array() || cells.size() > most_cells) refuse("'cells' is no list, or too long");
  for (const Json& cell : cells) {
    if (!cell.is_array() || cell.size() != 2 || !cell[0].is_number() || !cell[1].is_number()) refuse("a cell is no pair of numbers");
    asked.cells.emplace_back(cell[0].get<double>(), cell[1].get<double>());
  }
  return asked;
}

RunRequest report_request(const std::string& query, std::size_t models) {
  constexpr std::string_view k_model = "model=", k_values = "&values=";
  const std::size_t mark = query.find(k_values);
  if (!query.starts_with(k_model) || mark == std::string::npos) refuse("its address names no values");
  const std::string number = query.substr(k_model.size(), mark - k_model.size());
  if (number.empty() || number.size() > 6 || number.find_first_not_of("0123456789") != std::string::npos)
    refuse("its address names no model");
  return run_request("{\"model\":" + std::to_string(std::stoul(number)) +
                         ",\"values\":" + without_escapes(query.substr(mark + k_values.size())) + "}",
                     models);
}

std::string errors_json(const std::vector<Diagnostic>& problems) {
  Json errors = Json::array();
  for (const Diagnostic& problem : problems) errors.push_back(error_json(problem));
  return dumped({{"errors", std::move(errors)}});
}

std::string superseded_json() { return dumped({{"is_superseded", true}}); }

std::string run_json(const Report& report, long version, std::size_t budget) {
  return "{\"version\":" + std::to_string(version) +
         ",\"data\":" + report_data(results_of(report, SummaryText::left_out), summary_document(report), budget) + "}";
}

std::string map_json(const std::vector<MapCell>& cells) {
  Json list = Json::array();
  for (const MapCell& cell : cells) {
    if (!cell.error.empty()) {
      list.push_back({{"error", cell.error}});
      continue;
    }
    Json shares = Json::object();
    for (const auto& [name, share] : cell.shares) shares[name] = share;
    list.push_back({{"verdict", cell.verdict}, {"shares", std::move(shares)}});
  }
  return dumped({{"cells", std::move(list)}});
}

std::string saved_json(const std::string& file) { return dumped({{"file", file}}); }

std::string model_state_json(const ExploredModel& model, const std::vector<Diagnostic>& problems) {
  Json sliders = Json::array(), errors = Json::array();
  for (const Slider& s : model.sliders())
    sliders.push_back({{"path", s.path},
                       {"group", s.group},
                       {"unit", s.unit},
                       {"meaning", s.meaning},
                       {"value", s.value},
                       {"least", s.least},
                       {"most", s.most},
                       {"is_whole", s.is_whole},
                       {"has_own_range", s.has_own_range}});
  for (const Diagnostic& problem : problems) errors.push_back(error_json(problem));
  return dumped({{"name", std::filesystem::path(model.path()).stem().string()},
                 {"path", model.path()},
                 {"title", model.title()},
                 {"sliders", std::move(sliders)},
                 {"errors", std::move(errors)}});
}

std::string state_json(long version, const std::vector<std::string>& models) {
  std::string list;
  for (const std::string& model : models) list += (list.empty() ? "" : ",") + model;
  return "{\"program\":" + dumped(std::string("steplap ") + k_version) + ",\"version\":" + std::to_string(version) + ",\"models\":[" +
         list + "]}";
}

} // namespace steplap
