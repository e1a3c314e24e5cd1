// Data of a run for the screen: summary and events, of a new run or read from a folder.
#pragma once

#include "mbd/run/ordered_json.h"
#include "mbd/run/report.h"
#include "mbd/run/results.h"
#include "mbd/run/shown_quantity.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Cost of a run: data that differ between repetitions and are therefore not stored in files.
struct RunCost {
  double cpu_seconds = 0.0;
  std::optional<double> cost_of_estimate; ///< predicted time of an error estimate that was omitted because of it, s
  std::size_t rows = 0, channels = 0;     ///< size of the written trajectory
};

/// A run as shown on the screen.
struct ShownRun {
  OrderedJson summary;             ///< contents of summary.json (mbd/run/summary.h)
  std::vector<ResultEvent> events; ///< empty if only the overview is shown
  std::string folder;              ///< folder with the files of the run
  std::optional<RunCost> cost;
};

/// Returns the main part of the summary of a new run, without events, for the overview.
[[nodiscard]] ShownRun overview_of_run(const Report& report, const std::string& folder, ShownDigits digits);
/// Returns the complete summary and the events of a new run.
[[nodiscard]] ShownRun shown_run(const Report& report, const std::string& folder);
/// Writes each run's folder, summary and events if the stream is a JsonScreen. Returns false, without output, if it is not.
bool put_runs(std::ostream& out, const std::vector<ShownRun>& runs);
/// Reads a run from its folder and compares the files with their digests. Throws FileError.
[[nodiscard]] ShownRun shown_run(const std::string& folder);

} // namespace steplap
