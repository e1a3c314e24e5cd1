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
#include "mbd/run/report.h"

#include <string>
#include <vector>

namespace steplap {

/// A file of a run before it is written.
struct ResultFile {
  std::string name;    ///< file name within the folder of the run
  std::string content; ///< complete content, unless `parts` is set
  FileContent parts{}; ///< for large files: writes the content piece by piece instead of `content`
};

/// Writes trajectory.csv. `errors` has one entry per column, or is empty if errors were not estimated; NaN means unknown.
void write_trajectory_csv(const Trajectory& trajectory, const std::vector<double>& errors, const FileSink& put);
/// Returns the text of trajectory.csv.
[[nodiscard]] std::string trajectory_csv(const Trajectory& trajectory, const std::vector<double>& errors = {});
/// Returns the text of events.csv. `errors` are those of the times, s, one per event; nullptr if they were not estimated.
[[nodiscard]] std::string events_csv(const std::vector<Event>& events, const std::vector<double>* errors = nullptr);
/// Returns the text of model.toml; "" for a model without text.
[[nodiscard]] std::string model_file_text(const LoadedModel& loaded);
/// A written file, as listed in summary.json.
struct FileRecord {
  std::string name;      ///< file name within the folder of the run
  std::size_t bytes = 0; ///< size of the file
  std::string sha256;    ///< digest, hexadecimal
};
/// One record per file, in the order of writing.
using FileRecords = std::vector<FileRecord>;
/// Writes summary.json, which lists `files` and ends with a checksum of itself.
void write_summary(const Report& report, const FileRecords& files, const FileSink& put);
/// Returns the text of summary.json.
[[nodiscard]] std::string summary_json(const Report& report, const FileRecords& files);
/// Returns the text of a JSON object, which ends with "\n}\n", with the SHA-256 of the text before as its last entry.
[[nodiscard]] std::string with_checksum(std::string_view json);
/// Returns the part of such a text before its checksum; empty if the checksum is missing or wrong.
[[nodiscard]] std::string_view checked_content(std::string_view text);
/// Returns the files in the order of writing; the last one lists the others. They refer to `report`, which must outlive them.
[[nodiscard]] std::vector<ResultFile> result_files(const Report& report);

/// Thrown if the folder contains results of an earlier run. The user can choose another folder or allow overwriting.
class ResultsInTheWay : public FileError {
public:
  /// Takes the path of the folder.
  explicit ResultsInTheWay(const std::string& path)
      : FileError(path, "'" + path + "' holds the results of an earlier run: choose another folder, or overwrite them") {}
};

/// Checks before a long run that results can be written later. Throws ResultsInTheWay if `folder` contains results that must not be
/// overwritten, FileError if it is not writable.
void check_result_folder(const std::string& folder, bool is_overwriting);
/// Writes all files or none. Earlier results in `folder` are replaced if `is_overwriting`; files with other names are kept. Throws as
/// check_result_folder() does.
void write_results(const std::string& folder, const std::vector<ResultFile>& files, bool is_overwriting);

} // namespace steplap
