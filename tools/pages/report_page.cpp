#include "tools/pages/report_page.h"

#include "tools/pages/report_data.h"
#include "tools/pages/run/assets.h"

namespace steplap {

std::string escaped_html(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
    case '&': safe += "&amp;"; break;
    case '<': safe += "&lt;"; break;
    case '>': safe += "&gt;"; break;
    case '"': safe += "&quot;"; break;
    default: safe += c;
    }
  }
  return safe;
}

namespace {

std::string page_title(const std::vector<Results>& runs) {
  std::string names;
  for (const Results& run : runs) names += (names.empty() ? "" : ", ") + run.name;
  return "steplap: " + names;
}

} // namespace

std::string filled_page(std::string_view page, const std::map<std::string, std::string, std::less<>>& parts) {
  std::string text;
  while (!page.empty()) {
    const std::size_t begin = page.find('@');
    text += page.substr(0, begin);
    if (begin == std::string_view::npos) break;
    const std::size_t end = page.find('@', begin + 1);
    const auto part = end == std::string_view::npos ? parts.end() : parts.find(page.substr(begin + 1, end - begin - 1));
    if (part == parts.end()) {
      text += '@';
      page.remove_prefix(begin + 1);
    } else {
      text += part->second;
      page.remove_prefix(end + 1);
    }
  }
  return text;
}

std::string report_page(const std::vector<Results>& runs) {
  namespace assets = report_assets;
  return filled_page(assets::k_page_html, {{"PAGE_TITLE", escaped_html(page_title(runs))},
                                           {"DYGRAPHS_CSS", std::string(assets::k_dygraphs_css)},
                                           {"PAGE_CSS", std::string(assets::k_page_css)},
                                           {"DATA", report_data(runs)},
                                           {"DYGRAPHS_JS", std::string(assets::k_dygraphs_js)},
                                           {"PAGE_JS", std::string(assets::k_page_js)},
                                           {"DYGRAPHS_LICENCE", escaped_html(std::string(assets::k_dygraphs_licence))}});
}

} // namespace steplap
