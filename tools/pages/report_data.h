// What the page of a report is made of, as JSON: the runs' summaries, events, drawings and time histories,
// the histories thinned so that the page stays small.
#pragma once

#include "run/ordered_json.h"
#include "run/results.h"

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

/// JSON that can stand inside a <script> element: no '<' in it. Time histories are single precision,
/// as differences from their first value, in base 64; all together they take about `budget` bytes, for
/// which curves are thinned (thinning.h) and, where that is not enough, channels left out, those of plots,
/// drawings and reactions last.
/// Throws FileError for a summary.json or drawing.json that is not as steplap wrote it.
[[nodiscard]] std::string report_data(const std::vector<Results>& runs, std::size_t budget = 3500000);

/// The same of one run whose summary is at hand as a document (run/summary.h); its text in `run` is not looked at.
[[nodiscard]] std::string report_data(const Results& run, OrderedJson summary, std::size_t budget);

/// JSON without '<', which stands in strings only, where JSON has another way to write it.
[[nodiscard]] std::string in_script(const std::string& json);

} // namespace steplap
