// A report: one HTML file that needs no other file, no server and no network.
#pragma once

#include "run/results.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

/// The page of one or several runs. Throws FileError for results that are damaged.
[[nodiscard]] std::string report_page(const std::vector<Results>& runs);

/// Text that stands in HTML as it is.
[[nodiscard]] std::string escaped_html(const std::string& text);
/// "@NAME@" in the template becomes parts["NAME"]; what is put in is not looked at again.
[[nodiscard]] std::string filled_page(std::string_view page, const std::map<std::string, std::string, std::less<>>& parts);

} // namespace steplap
