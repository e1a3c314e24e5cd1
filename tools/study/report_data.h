// What the page of a study is made of, as JSON: all of it from the store.
#pragma once

#include "tools/study/store.h"

#include <cstddef>
#include <string>
#include <vector>

namespace steplap::study {

/// JSON that can stand inside a <script> element: no '<' in it. `store_path`: for the command that replays a sample.
/// Samples take about `budget` bytes: of more than fit, failed runs and failures
/// are kept rather than others, each evenly, and how many of how many is told.
[[nodiscard]] std::string report_data(Store& store, const std::string& store_path, std::size_t budget = 6000000);

/// Which of so many samples a page holds, in their order; `classes`: per sample 2 for a run that failed, 1 for a
/// failure, 0 for others.
[[nodiscard]] std::vector<std::size_t> chosen_samples(const std::vector<char>& classes, std::size_t most);

} // namespace steplap::study
