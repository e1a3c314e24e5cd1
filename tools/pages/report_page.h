// Creates a report of runs as one self-contained HTML file.
#pragma once

#include "mbd/run/results.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

/// Returns the page for one or several runs. Throws FileError for damaged results.
[[nodiscard]] std::string report_page(const std::vector<Results>& runs);

/// Escapes a text for HTML.
[[nodiscard]] std::string escaped_html(const std::string& text);
/// Replaces each "@NAME@" in the template by parts["NAME"]. "@NAME@" within inserted text is not replaced.
[[nodiscard]] std::string filled_page(std::string_view page, const std::map<std::string, std::string, std::less<>>& parts);

} // namespace steplap
