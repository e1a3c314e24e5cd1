// Writes the files of a run to a folder, either all or none:
//
//   trajectory.csv  time histories, units in the header row: "t [s],active part.x [m]"; if errors are estimated, a comment follows:
//                   "# error estimate," and the error of each column ("unknown" where it is not known)
//   events.csv      events: "t [s],element,event", and ",error of t [s]" if errors are estimated
//   model.toml      effective model with extended files and overrides merged; records by absolute path and SHA-256
//   drawing.json    geometry for drawings (drawing.h)
//   summary.json    settings, statistics, extremes of every channel, final state; inputs and the files above with their SHA-256,
//                   and at the end a SHA-256 of the text itself, which shows readers whether the results are complete
//
// The contents depend neither on the clock nor on the computer: two runs of a model give identical bytes. Whether errors are estimated is
// therefore decided by counting operations, not by time (estimate.h). The files of a run that did not reach its end are named
// partial_trajectory.csv and so on.
#pragma once

#include "mbd/io/atomic_file.h"
#include "run/report.h"

#include <string>
#include <vector>

namespace steplap {

/// A file of a run before it is written.
struct ResultFile {
  std::string name;    ///< in the folder of the run
  std::string content; ///< all of it, unless it is given in parts
  FileContent parts{}; ///< of what is too large to be held: given part by part instead of `content`
};

/// `errors`: of the columns, none if they were not estimated; not-a-number is unknown.
void write_trajectory_csv(const Trajectory& trajectory, const std::vector<double>& errors, const FileSink& put);
/// The text of trajectory.csv, in memory.
[[nodiscard]] std::string trajectory_csv(const Trajectory& trajectory, const std::vector<double>& errors = {});
/// The text of events.csv. `errors`: of the times, s, one per event; nullptr if they were not estimated.
[[nodiscard]] std::string events_csv(const std::vector<Event>& events, const std::vector<double>* errors = nullptr);
/// The text of model.toml: "" of a model that has no text.
[[nodiscard]] std::string model_file_text(const LoadedModel& loaded);
/// A file that was written, as summary.json lists it.
struct FileRecord {
  std::string name;      ///< in the folder of the run
  std::size_t bytes = 0; ///< its size
  std::string sha256;    ///< of its bytes, in hexadecimal digits
};
/// One per file, in the order in which they were written.
using FileRecords = std::vector<FileRecord>;
/// The text of summary.json, which lists `files` and ends with a checksum of itself.
[[nodiscard]] std::string summary_json(const Report& report, const FileRecords& files);
/// What comes before the checksum at the end of a summary; empty where that is not there or is not its own.
[[nodiscard]] std::string_view checked_summary(std::string_view text);
/// To be written in their order: the last one tells of the others. They refer to `report`, which has to outlive them.
[[nodiscard]] std::vector<ResultFile> result_files(const Report& report);

/// Results of an earlier run stand in the folder: another one helps, or to overwrite them.
class ResultsInTheWay : public FileError {
public:
  /// Of the folder at `path`.
  explicit ResultsInTheWay(const std::string& path)
      : FileError(path, "'" + path + "' holds the results of an earlier run: choose another folder, or overwrite them") {}
};

/// Throws ResultsInTheWay if results stand in `folder` that may not be overwritten, FileError if it cannot
/// be written: to be asked before a long run.
void check_result_folder(const std::string& folder, bool is_overwriting);
/// Writes all files, or none; earlier results in `folder` are replaced if `is_overwriting`, files of
/// other names stay. Throws as check_result_folder() does.
void write_results(const std::string& folder, const std::vector<ResultFile>& files, bool is_overwriting);

} // namespace steplap
