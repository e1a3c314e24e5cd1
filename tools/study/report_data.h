// Creates the data of a study's page as JSON, from the store only.
#pragma once

#include "tools/study/store.h"

#include <cstddef>
#include <string>
#include <vector>

namespace steplap::study {

/// Returns JSON that can be embedded in a <script> element: it contains no '<'. `store_path` is used in the command that replays a sample.
/// Samples take about `budget` bytes. If there are more, failed runs and failures are kept first, each evenly thinned, and the number of
/// samples shown is reported.
[[nodiscard]] std::string report_data(Store& store, const std::string& store_path, std::size_t budget = 6000000);

/// Selects the samples shown on a page, in their order. `classes` has one entry per sample: 2 for a failed run, 1 for a failure, 0
/// otherwise.
[[nodiscard]] std::vector<std::size_t> chosen_samples(const std::vector<char>& classes, std::size_t most);

} // namespace steplap::study
