#include "tools/pages/assessment_page.h"

#include "mbd/run/result_files.h"
#include "mbd/run/results.h"
#include "mbd/run/version.h"
#include "tools/pages/report_data.h"
#include "tools/pages/report_page.h"
#include "tools/pages/run/assets.h"
#include "tools/pages/thinning.h"

#include <nlohmann/json.hpp>

#include <algorithm>
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

Json read_written(const fs::path& file) {
  const std::string text = read_text(file.string());
  if (checked_content(text).empty())
    throw FileError(file.string(), "'" + file.string() +
                                       "' is not as steplap wrote it: its checksum is not that of its text, or is missing. Run steplap "
                                       "assess again");
  return Json::parse(text);
}

Json read_assessment(const fs::path& file) {
  Json assessment = read_written(file);
  Json& events = assessment["events"];
  const std::size_t stretches = std::clamp<std::size_t>(k_most_points / std::max<std::size_t>(6 * events.size(), 1), 30, 250);
  for (Json& event : events)
    if (event.contains("figure")) thin_figure(event["figure"], stretches);
  return assessment;
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
  if (fs::is_regular_file(proven, ignored)) data["static"] = read_written(proven);
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
