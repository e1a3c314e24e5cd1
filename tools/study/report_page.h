// Creates the page of a study: one self-contained HTML file.
#pragma once

#include "tools/study/store.h"

#include <string>

namespace steplap::study {

/// Returns the page. The same store at the same path gives identical bytes. `store_path` as for report_data().
[[nodiscard]] std::string report_page(Store& store, const std::string& store_path);

} // namespace steplap::study
