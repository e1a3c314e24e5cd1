#include "tools/study/report_page.h"

#include "tools/pages/run/assets.h"
#include "tools/pages/study/assets.h"
#include "tools/study/report_data.h"

#include <map>

namespace steplap::study {

namespace {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&') safe += "&amp;";
    else if (c == '<') safe += "&lt;";
    else if (c == '>') safe += "&gt;";
    else safe += c;
  }
  return safe;
}

// Replaces "@NAME@" in the template by the part of that name. Inserted text is not searched again.
std::string filled(std::string_view page, const std::map<std::string_view, std::string>& parts) {
  std::string text;
  while (!page.empty()) {
    const std::size_t begin = page.find('@');
    text += page.substr(0, begin);
    if (begin == std::string_view::npos) break;
    const std::size_t end = page.find('@', begin + 1);
    text += parts.at(page.substr(begin + 1, end - begin - 1));
    page.remove_prefix(end + 1);
  }
  return text;
}

} // namespace

std::string report_page(Store& store, const std::string& store_path) {
  namespace assets = page_assets;
  return filled(assets::k_page_html, {{"BASE_CSS", std::string(report_assets::k_page_css)},
                                      {"PAGE_CSS", std::string(assets::k_page_css)},
                                      {"DATA", report_data(store, store_path)},
                                      {"PLOTLY_JS", std::string(assets::k_plotly_js)},
                                      {"PAGE_JS", std::string(assets::k_page_js)},
                                      {"PLOTLY_LICENCE", escaped(assets::k_plotly_licence)}});
}

} // namespace steplap::study
