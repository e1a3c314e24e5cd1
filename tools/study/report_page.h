// The page of a study: one HTML file that needs no other file, no server and no network.
#pragma once

#include "tools/study/store.h"

#include <string>

namespace steplap::study {

/// The same store, read at the same place, makes the same bytes. `store_path` as for report_data().
[[nodiscard]] std::string report_page(Store& store, const std::string& store_path);

} // namespace steplap::study
