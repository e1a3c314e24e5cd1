#include "tools/pages/assessment_page.h"

#include "mbd/run/results.h"
#include "mbd/run/version.h"
#include "tools/pages/report_data.h"
#include "tools/pages/report_page.h"
#include "tools/pages/run/assets.h"
#include "tools/pages/thinning.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>
#include <vector>

namespace steplap {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t k_most_points = 60000; ///< largest number of points in the curves of all events together

[[noreturn]] void damaged(const fs::path& file, const std::string& what) {
  throw FileError(file.string(), "'" + file.string() + "': " + what + "; it is not as steplap wrote it: run steplap assess again");
}

// Returns the rank of a decision in ascending severity. "open" precedes "inspect", because an inspection can resolve it.
int gravity_of(std::string_view outcome) {
  constexpr std::array<std::string_view, 4> k_outcomes{"energise", "open", "inspect", "return"};
  const auto* const found = std::find(k_outcomes.begin(), k_outcomes.end(), outcome);
  return found == k_outcomes.end() ? -1 : static_cast<int>(found - k_outcomes.begin());
}

std::string text_in(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

Json list_in(const Json& object, const char* key) { return object.contains(key) && object[key].is_array() ? object[key] : Json::array(); }

void check_probability(const fs::path& file, const Json& object, const char* key, const std::string& where) {
  if (!object.is_object() || !object.contains(key) || object[key].is_null()) return;
  const Json& p = object[key];
  const auto number = [&](const char* name) {
    if (!p.is_object() || !p.contains(name) || !p[name].is_number()) damaged(file, where + ": " + key + " has no number '" + name + "'");
    return p[name].get<double>();
  };
  const double value = number("value"), low = number("low"), high = number("high");
  if (!(low >= 0.0 && low <= value && value <= high && high <= 1.0))
    damaged(file, where + ": " + key + " does not lie within its interval, or that not between 0 and 1");
}

// Keys whose values must be numbers, or null, in any object.
const std::set<std::string_view> k_numbers{
    "acceleration", "allowed",      "angle_deg",     "at",    "ax",         "ay",     "bandwidth",       "error",
    "from",         "height",       "high",          "left",  "low",        "margin", "nominal",         "overlap_left",
    "runs",         "sensor_range", "covered_share", "share", "slid_total", "value",  "velocity_change", "worst_time"};
const std::set<std::string_view> k_texts{"arrival",     "axis",   "calibrated",  "covered",   "departure", "filter", "journey", "place",
                                         "range",       "serial", "transformer", "criterion", "file",      "first",  "law",     "marker",
                                         "model",       "name",   "outcome",     "plane",     "preset",    "reason", "sha256",  "source",
                                         "source_text", "trust",  "unit",        "verdict",   "why"};
const std::set<std::string_view> k_lists_of_objects{"cases",     "handovers", "recorders", "clearances",    "feet",
                                                    "joints",    "limits",    "models",    "peaks",         "polar",
                                                    "reactions", "reasons",   "records",   "static_proofs", "uncertain"};
const std::set<std::string_view> k_lists_of_texts{"assumptions", "findings",  "hangs_on", "knows_not",
                                                  "remarks",     "taken_for", "tests",    "warnings"};

// Throws FileError if a value has the wrong type, because the page would print a text in place of a number.
void check_types(const fs::path& file, const Json& json, const std::string& where) {
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i)
      if (json[i].is_structured()) check_types(file, json[i], where + "[" + std::to_string(i) + "]");
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    if (value.is_null()) continue;
    const std::string place = where.empty() ? key : where + "." + key;
    if (k_numbers.contains(key) && !value.is_number()) damaged(file, "'" + place + "' is not a number");
    if (k_texts.contains(key) && !value.is_string()) damaged(file, "'" + place + "' is not a text");
    const bool holds_objects = k_lists_of_objects.contains(key), holds_texts = k_lists_of_texts.contains(key);
    if ((holds_objects || holds_texts) && !value.is_array()) damaged(file, "'" + place + "' is not a list");
    for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
      if ((holds_objects && !value[i].is_object()) || (holds_texts && !value[i].is_string()))
        damaged(file, "'" + place + "[" + std::to_string(i) + "]' is not " + (holds_objects ? "an object" : "a text"));
    if (value.is_structured() && key != "figure" && key != "drawing" && key != "poses") check_types(file, value, place);
  }
}

// Throws FileError if data required for a drawing is missing.
void check_drawing(const fs::path& file, const Json& holder, const std::string& where) {
  if (!holder.contains("drawing") || holder["drawing"].is_null()) return;
  const Json& drawing = holder["drawing"];
  for (const char* key : {"bodies", "elements", "planes", "sheets"})
    if (!drawing.is_object() || !drawing.contains(key) || !drawing[key].is_array())
      damaged(file, "the drawing of " + where + " has no list '" + key + "'");
}

void check_event(const fs::path& file, const Json& event, const std::string& where) {
  if (!event.is_object()) damaged(file, where + " is not an object");
  for (const Json& model : list_in(event, "models")) check_probability(file, model, "slip_probability", where);
}

void check_assessment(const fs::path& file, const Json& assessment) {
  if (!assessment.is_object()) damaged(file, "no object");
  const std::string decision = text_in(assessment, "decision");
  if (gravity_of(decision) < 0) damaged(file, "'decision' is '" + decision + "' instead of energise, inspect, return or open");
  if (!assessment.contains("events")) damaged(file, "there are no 'events'");
  if (!assessment["events"].is_array()) damaged(file, "'events' is not a list");
  check_types(file, assessment, "");
  for (const Json& reason : list_in(assessment, "reasons"))
    if (gravity_of(text_in(reason, "outcome")) > gravity_of(decision))
      damaged(file, "the decision is '" + decision + "', but criterion '" + text_in(reason, "criterion") + "' asks for '" +
                        text_in(reason, "outcome") + "'");
  for (const Json& model : list_in(assessment, "models")) check_drawing(file, model, "model '" + text_in(model, "name") + "'");
  std::size_t place = 0;
  for (const Json& event : assessment["events"]) check_event(file, event, "event " + std::to_string(++place));
  if (assessment.contains("voyage")) check_probability(file, assessment["voyage"], "damage_probability", "the voyage");
}

std::vector<double> numbers_of(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list.is_array() ? list : Json::array())
    values.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
  return values;
}

// Rounds numbers to five digits, which is more than a picture shows.
Json rounded(const Json& value) {
  if (!value.is_number()) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value.get<double>());
  return std::strtod(text, nullptr);
}

// Reduces the curves of a figure to `stretches` intervals. Times keep all digits, because their differences are small.
void thin_figure(Json& figure, std::size_t stretches) {
  if (!figure.is_object() || !figure.contains("times") || !figure["times"].is_array()) return;
  const std::size_t count = figure["times"].size();
  std::set<std::size_t> kept;
  for (const char* axis : {"x", "y", "z"})
    if (figure.contains(axis) && figure[axis].is_array() && figure[axis].size() == count)
      for (const std::size_t i : thinned(numbers_of(figure[axis]), stretches)) kept.insert(i);
  for (const char* key : {"times", "x", "y", "z"}) {
    if (!figure.contains(key) || !figure[key].is_array() || figure[key].size() != count) continue;
    Json list = Json::array();
    for (const std::size_t i : kept) list.push_back(std::string_view(key) == "times" ? figure[key][i] : rounded(figure[key][i]));
    figure[key] = std::move(list);
  }
}

Json read_json(const fs::path& file) {
  Json json = Json::parse(read_text(file.string()), nullptr, false);
  if (json.is_discarded()) damaged(file, "this is no JSON");
  return json;
}

Json read_assessment(const fs::path& file) {
  Json assessment = read_json(file);
  check_assessment(file, assessment);
  Json& events = assessment["events"];
  const std::size_t stretches = std::clamp<std::size_t>(k_most_points / std::max<std::size_t>(6 * events.size(), 1), 30, 250);
  for (Json& event : events)
    if (event.contains("figure")) thin_figure(event["figure"], stretches);
  return assessment;
}

Json read_static(const fs::path& file) {
  Json proofs = read_json(file);
  if (!proofs.is_object()) damaged(file, "no object");
  check_types(file, proofs, "");
  const Json list = proofs.contains("static_proofs") ? list_in(proofs, "static_proofs") : Json::array({proofs});
  if (list.empty()) damaged(file, "it holds no proof");
  for (const Json& proof : list) {
    check_drawing(file, proof, "model '" + text_in(proof, "model") + "'");
    const std::string verdict = text_in(proof, "verdict");
    if (verdict != "hold" && verdict != "reject" && verdict != "open")
      damaged(file, "'verdict' is '" + verdict + "' instead of hold, reject or open");
    for (const Json& one : list_in(proof, "cases"))
      if (verdict == "hold" && text_in(one, "verdict") != "hold")
        damaged(file, "the verdict is 'hold', but that of case '" + text_in(one, "name") + "' is '" + text_in(one, "verdict") + "'");
  }
  return proofs;
}

} // namespace

bool is_assessment(const std::string& folder) {
  std::error_code ignored;
  return fs::is_regular_file(fs::path(folder) / "assessment.json", ignored) ||
         fs::is_regular_file(fs::path(folder) / "static.json", ignored);
}

OrderedJson assessment_data(const std::string& folder) {
  const fs::path assessed = fs::path(folder) / "assessment.json", proven = fs::path(folder) / "static.json";
  std::error_code ignored;
  Json data{{"program", std::string("steplap ") + k_version}, {"folder", folder}, {"runs", Json::array()}};
  if (fs::is_regular_file(assessed, ignored)) data["assessment"] = read_assessment(assessed);
  if (fs::is_regular_file(proven, ignored)) data["static"] = read_static(proven);
  return data;
}

std::string assessment_page(const std::string& folder) {
  namespace assets = report_assets;
  const Json data = assessment_data(folder);
  return filled_page(assets::k_assessment_html, {{"PAGE_TITLE", escaped_html("steplap assessment: " + folder)},
                                                 {"PAGE_CSS", std::string(assets::k_page_css)},
                                                 {"SHEET_CSS", std::string(assets::k_sheet_css)},
                                                 {"DATA", in_script(data.dump(-1, ' ', false, Json::error_handler_t::replace))},
                                                 {"PAGE_JS", std::string(assets::k_assessment_js)}});
}

} // namespace steplap
