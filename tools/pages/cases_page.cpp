#include "tools/pages/cases_page.h"

#include "mbd/run/drawing.h"
#include "mbd/run/version.h"
#include "tools/pages/report_data.h"
#include "tools/pages/report_page.h"
#include "tools/pages/run/assets.h"

#include <nlohmann/json.hpp>

namespace steplap {

std::string cases_page(const LoadedModel& model, const OrderedJson& document) {
  namespace assets = report_assets;
  const OrderedJson data{
      {"program", std::string("steplap ") + k_version}, {"runs", OrderedJson::array({still_run(model)})}, {"load_cases", document}};
  return filled_page(assets::k_cases_html, {{"PAGE_TITLE", escaped_html("steplap cases: " + model.name)},
                                            {"PAGE_CSS", std::string(assets::k_page_css)},
                                            {"DATA", in_script(data.dump(-1, ' ', false, OrderedJson::error_handler_t::replace))},
                                            {"PAGE_JS", std::string(assets::k_cases_js)}});
}

} // namespace steplap
