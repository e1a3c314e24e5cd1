// The files of this folder and dygraphs, as text inside the program (CMake writes assets.cpp).
#pragma once

#include <string_view>

namespace steplap::report_assets {

extern const std::string_view k_page_html, k_page_css, k_page_js, k_modes_html, k_modes_js, k_sheet_html, k_sheet_css, k_sheet_js,
    k_assessment_html, k_assessment_js;
extern const std::string_view k_dygraphs_css, k_dygraphs_js, k_dygraphs_licence;

} // namespace steplap::report_assets
