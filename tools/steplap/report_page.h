// A report: one HTML file that needs no other file, no server and no network.
#pragma once

#include "tools/steplap/results.h"

#include <string>
#include <vector>

namespace steplap {

/// The page of one or several runs. Throws UsageError for results that are damaged.
[[nodiscard]] std::string report_page(const std::vector<Results>& runs);

} // namespace steplap
