// A run as the screen shows it: what its summary and its events say, of a run just made as of one read back.
#pragma once

#include "run/ordered_json.h"
#include "run/report.h"
#include "run/results.h"
#include "run/shown_quantity.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// What only the process that made a run knows of it: no two runs share it, so that it stands in no file.
struct MakingOfRun {
  double cpu_seconds = 0.0;
  std::optional<double> cost_of_estimate; ///< s, where errors were not estimated for that
  std::size_t rows = 0, channels = 0;     ///< of the trajectory written
};

struct ShownRun {
  OrderedJson summary;             ///< run/summary.h
  std::vector<ResultEvent> events; ///< empty if only the overview is shown
  std::string folder;              ///< of its files
  std::optional<MakingOfRun> making;
};

/// Of a run just made; without events and all that follows the head of its summary if only the overview is shown.
[[nodiscard]] ShownRun overview_of_run(const Report& report, const std::string& folder, ShownDigits digits);
[[nodiscard]] ShownRun shown_run(const Report& report, const std::string& folder);
/// For programs: each run's folder, summary and events. False if people read the stream, and nothing was written.
bool put_runs(std::ostream& out, const std::vector<ShownRun>& runs);
/// Of a run read back from its folder, whose files are held against their digests. Throws FileError.
[[nodiscard]] ShownRun shown_run(const std::string& folder);

} // namespace steplap
