// Creates the data of a report page as JSON: summaries, events, drawings and time histories of runs, thinned to limit the size of the page.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/results.h"

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

/// Returns JSON that can be embedded in a <script> element: it contains no '<'. Time histories are differences from their first value, in
/// single precision and base 64. They take about `budget` bytes in total: curves are thinned (thinning.h), and channels are omitted if
/// necessary, those of plots, drawings and reactions last. Throws FileError for a summary.json or drawing.json that steplap did not write.
[[nodiscard]] std::string report_data(const std::vector<Results>& runs, std::size_t budget = 3500000);

/// As above for one run, whose summary is given as a document (mbd/run/summary.h); the summary text in `run` is ignored.
[[nodiscard]] std::string report_data(const Results& run, OrderedJson summary, std::size_t budget);

/// Returns the data of a run without time histories, for pages with a drawing only.
[[nodiscard]] OrderedJson run_without_histories(const LoadedModel& loaded);

/// Returns the data of a run at its worst instant, or at its end if it has none, without time histories. Throws as report_data().
[[nodiscard]] OrderedJson run_without_histories(Results run);

/// Returns equivalent JSON without '<', which is escaped; it occurs within strings only.
[[nodiscard]] std::string in_script(const std::string& json);

} // namespace steplap
