#include "tools/pages/sheet_page.h"

#include "mbd/run/version.h"
#include "tools/pages/assessment_page.h"
#include "tools/pages/load_case.h"
#include "tools/pages/report_data.h"
#include "tools/pages/report_page.h"
#include "tools/pages/run/assets.h"

#include <nlohmann/json.hpp>

namespace steplap {

namespace {

std::string sheet_page(const std::string& title, const OrderedJson& data) {
  namespace assets = report_assets;
  return filled_page(assets::k_sheet_html, {{"PAGE_TITLE", escaped_html("steplap " + title)},
                                            {"PAGE_CSS", std::string(assets::k_page_css)},
                                            {"SHEET_CSS", std::string(assets::k_sheet_css)},
                                            {"DATA", in_script(data.dump(-1, ' ', false, OrderedJson::error_handler_t::replace))},
                                            {"PAGE_JS", std::string(assets::k_sheet_js)}});
}

} // namespace

std::string cases_sheet(const std::vector<std::shared_ptr<const LoadedModel>>& models, const OrderedJson& document) {
  OrderedJson data{{"program", std::string("steplap ") + k_version}, {"runs", OrderedJson::array()}, {"load_cases", document}};
  for (const auto& model : models) data["runs"].push_back(run_without_histories(*model));
  return sheet_page("cases: " + models.front()->name, data);
}

std::string run_sheet(Results run) {
  const std::string title = "run: " + run.name;
  const double end = run.times.back();
  const std::string model = run.model;
  OrderedJson still = run_without_histories(std::move(run));
  still["run_end"] = end;
  still["load_case"] = load_case_json(model, still["drawing"]);
  return sheet_page(title, {{"program", std::string("steplap ") + k_version}, {"runs", OrderedJson::array({std::move(still)})}});
}

std::string assessment_sheet(const std::string& folder) { return sheet_page("assessment: " + folder, assessment_data(folder)); }

} // namespace steplap
