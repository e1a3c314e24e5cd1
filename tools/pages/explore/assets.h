// The page of `steplap explore` as text inside the program (CMake writes assets.cpp), with the drawing of machine and curves of tools/pages/run.
#pragma once

#include <string_view>

namespace steplap::explore_assets {

extern const std::string_view k_explore_html, k_explore_css, k_explore_js;

} // namespace steplap::explore_assets
