// Reads the folder of a run, from which reports and plots are made.
#pragma once

#include "mbd/base/event_kind.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A column of trajectory.csv.
struct ResultChannel {
  std::string name, unit;     ///< as in the header row: "active part.x", "m"
  std::vector<double> values; ///< SI values; may contain NaN and infinities
};

/// A row of events.csv.
struct ResultEvent {
  double t = 0.0;                   ///< time, s
  std::string element;              ///< name of the element
  std::string words;                ///< text of the event as in the file, for display
  EventKind kind = EventKind::none; ///< kind with this text; `none` if this program does not know the text
  std::optional<double> error = {}; ///< error of t, s; empty: not estimated; NaN: unknown
};

/// Contents of the folder of a run.
struct Results {
  std::string folder;                  ///< path of the folder, as given
  std::string name;                    ///< last part of the folder
  bool is_partial = false;             ///< true for a run that did not reach its end
  std::vector<double> times;           ///< sampling times, s, ascending
  std::vector<ResultChannel> channels; ///< one value per sampling time in each
  std::vector<ResultEvent> events;     ///< ascending in time
  std::string model, drawing, summary; ///< texts of model.toml, drawing.json, summary.json
  std::string model_date;              ///< modification date of model.toml, "2026-01-31 13:05 UTC"
};

/// Amount of data to read.
enum class Reading {
  all,         ///< everything
  without_rows ///< all except times and channels, which are most of the data of a long run
};

/// Reads the files written by `steplap simulate` and compares all of them with the digests in the summary. Throws FileError, with file and
/// line, if results are missing, incomplete or modified.
[[nodiscard]] Results read_results(const std::string& folder, Reading reading = Reading::all);

/// Returns the bytes of a file. Throws FileError if it cannot be read.
[[nodiscard]] std::string read_text(const std::string& file);

/// Returns the channels whose names match the pattern, in their order.
[[nodiscard]] std::vector<const ResultChannel*> matching_channels(const Results& results, const std::string& pattern);

} // namespace steplap
