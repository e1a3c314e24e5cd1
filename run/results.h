// The folder of a run read back: what reports and plots are made from, nothing else.
#pragma once

#include "mbd/base/event_kind.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A column of trajectory.csv.
struct ResultChannel {
  std::string name, unit;     ///< as in the header row: "active part.x", "m"
  std::vector<double> values; ///< SI; may hold not-a-number and infinities
};

/// A row of events.csv.
struct ResultEvent {
  double t = 0.0;                   ///< s
  std::string element;              ///< its name
  std::string words;                ///< as they stand in the file, to be shown
  EventKind kind = EventKind::none; ///< what they mean; none: nothing that this program knows
  std::optional<double> error = {}; ///< s, of t, if it was estimated; not-a-number: unknown
};

/// All that the folder of a run holds.
struct Results {
  std::string folder;                  ///< as given
  std::string name;                    ///< last part of the folder
  bool is_partial = false;             ///< of a run that did not reach its end
  std::vector<double> times;           ///< s, ascending
  std::vector<ResultChannel> channels; ///< as many values each as there are times
  std::vector<ResultEvent> events;     ///< ascending in time
  std::string model, drawing, summary; ///< texts of model.toml, drawing.json, summary.json
  std::string model_date;              ///< of model.toml, "2026-01-31 13:05 UTC"
};

/// How much of a folder is read.
enum class Reading {
  all,         ///< everything
  without_rows ///< times and channels are left empty: of a long run nearly all there is
};

/// Reads the files that `steplap simulate` writes, all of which are held against the digests in the summary. Throws FileError for a folder that holds no results,
/// or not all of them, and for files that are not as they were written; names the file and the line.
[[nodiscard]] Results read_results(const std::string& folder, Reading reading = Reading::all);

/// The bytes of a file. Throws FileError if it cannot be read.
[[nodiscard]] std::string read_text(const std::string& file);

/// Channels whose names match the pattern, in their order; none if there is no such channel.
[[nodiscard]] std::vector<const ResultChannel*> matching_channels(const Results& results, const std::string& pattern);

} // namespace steplap
