// The files of this folder and Plotly, as text inside the program (CMake writes assets.cpp).
#pragma once

#include <string_view>

namespace steplap::study::page_assets {

extern const std::string_view k_page_html, k_page_css, k_page_js, k_plotly_js, k_plotly_licence;

} // namespace steplap::study::page_assets
