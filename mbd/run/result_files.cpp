#include "mbd/run/result_files.h"

#include "mbd/base/number_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/csv.h"
#include "mbd/io/digest.h"
#include "mbd/run/drawing.h"
#include "mbd/run/version.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

namespace steplap {

namespace fs = std::filesystem;

namespace {

constexpr const char* k_names[] = {"trajectory.csv", "events.csv", "model.toml", "drawing.json", "summary.json"};
// Files that other commands create from the results, and that are removed when the results are replaced.
constexpr const char* k_pages[] = {"report.html", "sheet.html"};
constexpr const char* k_partial = "partial_";
// a random part follows, because processes in different containers may have the same process number
constexpr const char* k_staging = ".steplap-";
constexpr std::chrono::minutes k_locked_within{1};

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const char* name : k_names) {
    names.emplace_back(name);
    names.push_back(std::string(k_partial) + name);
  }
  return names;
}

[[noreturn]] void fail(const std::string& folder, const std::string& cause) {
  throw FileError(folder, "cannot write results to '" + folder + "': " + cause);
}

// Returns the nearest existing parent folder.
fs::path existing_part(fs::path path) {
  path = fs::absolute(path);
  std::error_code ignored;
  while (!fs::exists(path, ignored) && path.has_parent_path() && path != path.parent_path()) path = path.parent_path();
  return path;
}

// Lock of a folder. The system releases it when the process ends for any reason. Not held if another process holds it, or if the file
// system has no locks.
class FolderLock {
public:
  FolderLock() = default;
  explicit FolderLock(const fs::path& folder) : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
    is_held_ = descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  }
  FolderLock(FolderLock&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), is_held_(std::exchange(other.is_held_, false)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(is_held_, other.is_held_);
    return *this;
  }
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  [[nodiscard]] bool is_held() const { return is_held_; }

private:
  int descriptor_ = -1;
  bool is_held_ = false;
};

// A temporary folder next to the target, in which files are collected. The destructor removes it with its contents, and also its parent
// folder if the constructor created that and it is still empty.
class Staging {
public:
  explicit Staging(const fs::path& folder) {
    fs::path parent = folder.parent_path();
    if (parent.empty()) parent = ".";
    std::error_code error;
    if (fs::create_directories(parent, error)) made_ = parent;
    if (error) fail(folder.string(), error.message());
    remove_left(parent);
    std::string name = (parent / (std::string(k_staging) + "XXXXXX")).string();
    if (!::mkdtemp(name.data())) fail(folder.string(), std::strerror(errno));
    outer_ = name;
    lock_ = FolderLock(outer_);
    fs::create_directory(path(), error); // inner folder with the usual permissions; mkdtemp() makes the outer one private
    if (error) {
      remove();
      fail(folder.string(), error.message());
    }
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  ~Staging() { remove(); }

  [[nodiscard]] fs::path path() const { return outer_ / "results"; }

private:
  void remove() {
    std::error_code ignored;
    fs::remove_all(outer_, ignored);
    if (!made_.empty()) fs::remove(made_, ignored);
  }

  // Removes temporary folders of processes that were killed while writing: those without a lock that are older than k_locked_within. A
  // younger one may not be locked yet.
  static void remove_left(const fs::path& parent) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(parent, ignored)) {
      if (!entry.path().filename().string().starts_with(k_staging) || !entry.is_directory(ignored) || entry.is_symlink(ignored)) continue;
      const fs::file_time_type changed = entry.last_write_time(ignored);
      if (ignored || fs::file_time_type::clock::now() - changed < k_locked_within) continue;
      if (const FolderLock lock(entry.path()); lock.is_held()) fs::remove_all(entry.path(), ignored);
    }
  }

  FolderLock lock_;
  fs::path outer_, made_;
};

// Messages use the target path, which the user knows, instead of the temporary one.
void write_all(const fs::path& staging, const fs::path& folder, const std::vector<ResultFile>& files) {
  for (const ResultFile& file : files) {
    const std::string path = (staging / file.name).string();
    try {
      if (file.parts) write_file(path, file.parts);
      else write_file(path, file.content);
    } catch (const FileError& error) {
      std::string message = error.what();
      if (const auto at = message.find(path); at != std::string::npos) message.replace(at, path.size(), (folder / file.name).string());
      throw FileError((folder / file.name).string(), message);
    }
  }
}

// Moves the files one by one into an existing folder. Files of an earlier run are removed; the summary is moved last.
void move_into(const fs::path& staging, const fs::path& folder, const std::vector<ResultFile>& files) {
  std::error_code error;
  std::vector<std::string> outdated = all_names();
  outdated.insert(outdated.end(), std::begin(k_pages), std::end(k_pages));
  for (const std::string& name : outdated)
    if (fs::remove(folder / name, error); error) fail(folder.string(), error.message());
  for (const ResultFile& file : files)
    if (fs::rename(staging / file.name, folder / file.name, error); error) fail(folder.string(), error.message());
}

} // namespace

namespace {

std::string error_field(double error) { return std::isnan(error) ? "unknown" : number_text(error); }

std::vector<double> column_errors(const Report& report) {
  std::vector<double> errors;
  if (!report.estimate.errors) return errors;
  const Channel* first = report.run.loaded->system->channels.data();
  for (const Channel* channel : report.run.result.trajectory->channels())
    errors.push_back(report.estimate.errors->channels[static_cast<std::size_t>(channel - first)].curve);
  return errors;
}

} // namespace

void write_trajectory_csv(const Trajectory& trajectory, const std::vector<double>& errors, const FileSink& put) {
  constexpr std::size_t k_part = 1 << 16; // bytes per piece, about the size of a cache
  std::vector<std::string> header{"t [s]"};
  for (const Channel* channel : trajectory.channels())
    header.push_back(channel->name + (channel->unit.empty() ? "" : " [" + channel->unit + "]"));
  CsvText csv(header);
  if (!errors.empty()) {
    std::string comment = "# error estimate";
    for (const double error : errors) comment += "," + error_field(error);
    csv.add_comment(comment);
  }
  for (std::size_t row = 0; row < trajectory.size(); ++row) {
    csv.add_row(trajectory.row(row));
    if (csv.text().size() < k_part) continue;
    put(csv.text());
    csv.clear();
  }
  put(csv.text());
}

std::string trajectory_csv(const Trajectory& trajectory, const std::vector<double>& errors) {
  std::string text;
  write_trajectory_csv(trajectory, errors, [&text](std::string_view part) { text += part; });
  return text;
}

std::string events_csv(const std::vector<Event>& events, const std::vector<double>* errors) {
  std::string text = errors ? "t [s],element,event,error of t [s]\n" : "t [s],element,event\n";
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    text += number_text(event.t) + "," + csv_field(event.element) + "," + csv_field(event.words());
    if (errors) text += "," + error_field((*errors)[i]);
    text += "\n";
  }
  return text;
}

namespace {

// Returns the file with a content that also computes its size and digest while it is written; they are in `records` after the last piece.
ResultFile noted(std::string name, FileContent content, const std::shared_ptr<FileRecords>& records) {
  FileContent put_and_note = [name, content = std::move(content), records](const FileSink& put) {
    FileRecord record{name, 0, ""};
    Sha256 digest;
    content([&](std::string_view part) {
      record.bytes += part.size();
      digest.add(part);
      put(part);
    });
    record.sha256 = digest.hex();
    records->push_back(std::move(record));
  };
  return {std::move(name), "", std::move(put_and_note)};
}

FileContent whole(std::string text) {
  return [text = std::move(text)](const FileSink& put) { put(text); };
}

std::string model_file_head(const LoadedModel& loaded) {
  return "# Effective model of '" + loaded.path + "', written by steplap " + k_version + ".\n\n";
}

} // namespace

std::string model_file_text(const LoadedModel& loaded) { return loaded.text.empty() ? "" : model_file_head(loaded) + loaded.text; }

std::vector<ResultFile> result_files(const Report& report) {
  const Run& run = report.run;
  if (run.loaded->text.empty())
    throw FileError(run.loaded->path,
                    "results of '" + run.loaded->name +
                        "' cannot be written: it was made in code, and model.toml has to hold a model that can be run again");
  const std::string prefix = run.failure ? k_partial : "";
  const auto rows = [&run, errors = column_errors(report)](const FileSink& put) {
    write_trajectory_csv(*run.result.trajectory, errors, put);
  };
  const auto model = [&run](const FileSink& put) {
    put(model_file_head(*run.loaded));
    put(run.loaded->text);
  };
  const auto drawing = [&run](const FileSink& put) { write_drawing(run.loaded->model, *run.loaded->views, put); };
  const auto records = std::make_shared<FileRecords>();
  const auto events = events_csv(run.result.events, report.estimate.errors ? &report.estimate.errors->event_times : nullptr);
  return {noted(prefix + "trajectory.csv", rows, records),
          noted(prefix + "events.csv", whole(events), records),
          noted(prefix + "model.toml", model, records),
          noted(prefix + "drawing.json", drawing, records),
          {prefix + "summary.json", "", [&report, records](const FileSink& put) { write_summary(report, *records, put); }}};
}

void check_result_folder(const std::string& folder, bool is_overwriting) {
  std::error_code ignored;
  for (const std::string& name : all_names())
    if (!is_overwriting && fs::exists(fs::path(folder) / name, ignored)) throw ResultsInTheWay(folder);
  const fs::path existing = existing_part(folder);
  if (!fs::is_directory(existing)) fail(folder, "'" + existing.string() + "' is not a folder");
  if (::access(existing.c_str(), W_OK | X_OK) != 0) fail(folder, std::strerror(errno));
}

void write_results(const std::string& folder, const std::vector<ResultFile>& files, bool is_overwriting) {
  check_result_folder(folder, is_overwriting);
  const Staging staging(folder);
  write_all(staging.path(), folder, files);
  std::error_code error;
  fs::rename(staging.path(), folder, error); // rename() succeeds if the target does not exist or is an empty folder
  if (!error) return;
  if (!fs::is_directory(folder)) fail(folder, error.message());
  check_result_folder(folder, is_overwriting); // another process may have created results in the meantime
  move_into(staging.path(), folder, files);
}

} // namespace steplap
