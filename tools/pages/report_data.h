// Creates the data of a report page as JSON: summaries, events, drawings and time histories of runs, thinned to limit the size of the page.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/results.h"

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

/// Returns JSON that can be embedded in a <script> element: it contains no '<'. Time histories are single-precision differences from their
/// first value, in base 64. They take about `budget` bytes in total. To achieve this, curves are thinned (thinning.h) and, if necessary,
/// channels are omitted; those of plots, drawings and reactions are omitted last. Throws FileError for a summary.json or drawing.json that
/// steplap did not write.
[[nodiscard]] std::string report_data(const std::vector<Results>& runs, std::size_t budget = 3500000);

/// As above for one run, whose summary is given as a document (mbd/run/summary.h); the summary text in `run` is ignored.
[[nodiscard]] std::string report_data(const Results& run, OrderedJson summary, std::size_t budget);

/// Returns the data of a run without time histories, for pages that draw the model only.
[[nodiscard]] OrderedJson still_run(const LoadedModel& loaded);

/// Returns the data of a run with its channels at its worst instant only, or at its end if it has none. Throws as report_data().
[[nodiscard]] OrderedJson still_run(Results run);

/// Returns equivalent JSON without '<'. The character occurs in strings only, where it can be escaped.
[[nodiscard]] std::string in_script(const std::string& json);

} // namespace steplap
