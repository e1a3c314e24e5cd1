#include "transformer/recorder/result_folder.h"

#include "mbd/base/diagnostics.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace steplap {

namespace fs = std::filesystem;

RecordFolder::RecordFolder(const std::string& folder, bool is_overwriting)
    : folder_(fs::path(folder).lexically_normal()), is_overwriting_(is_overwriting) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path(); // removes the slash of "out/"
  if (folder_.empty()) folder_ = ".";
  refuse_existing({"record.json", "events.csv"});
  std::error_code error;
  // Parent of the temporary folder: that of the result folder or, if it does not exist yet, the nearest existing one.
  fs::path beside = folder_;
  while (!beside.empty() && !fs::exists(beside, error)) beside = beside.parent_path();
  if (beside.empty()) beside = ".";
  if (!fs::is_directory(beside, error)) fail("'" + beside.string() + "' is no folder");
  bool is_new = false;
  for (int i = 1; !is_new; ++i) {
    staging_ = beside / (".steplap-record-" + std::to_string(::getpid()) + "-" + std::to_string(i));
    is_new = fs::create_directory(staging_, error);
    if (error) fail(error.message());
  }
}

RecordFolder::~RecordFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void RecordFolder::fail(const std::string& why) const {
  throw FileError(folder_.string(), "'" + folder_.string() + "' cannot be written: " + why);
}

void RecordFolder::refuse_existing(const std::vector<std::string>& names) const {
  std::error_code error;
  for (const std::string& name : names)
    if (const fs::path path = folder_ / name; !is_overwriting_ && fs::exists(path, error))
      throw FileError(path.string(), "'" + path.string() + "' exists. Choose another folder with -o, or give --force to overwrite it.");
}

std::vector<std::string> RecordFolder::commit() {
  std::error_code error;
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  refuse_existing(names);
  const auto is_signal = [](const std::string& name) { return name.starts_with("signal") && name.ends_with(".csv"); };
  fs::create_directories(folder_, error);
  if (error) fail(error.message());
  std::vector<fs::path> outdated;
  if (std::any_of(names.begin(), names.end(), is_signal))
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      if (is_signal(entry.path().filename().string())) outdated.push_back(entry.path());
  for (const fs::path& path : outdated)
    if (is_overwriting_ && !fs::remove(path, error) && error) fail(error.message());
  for (const std::string& name : names)
    if (fs::rename(staging_ / name, folder_ / name, error); error) fail(error.message());
  return names;
}

} // namespace steplap
