// Writes the results for a record to a folder, either all files or none.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace steplap {

/// Collects files in a hidden folder on the same disk and moves them to the result folder at the end.
class RecordFolder {
public:
  /// Creates the hidden folder. Throws FileError if `folder` contains results that must not be replaced, or is not writable.
  RecordFolder(const std::string& folder, bool is_overwriting);
  RecordFolder(const RecordFolder&) = delete;
  RecordFolder& operator=(const RecordFolder&) = delete;
  /// Removes all files and folders created, unless commit() was called.
  ~RecordFolder();

  /// Returns the path of the hidden folder, to which files are written before commit().
  [[nodiscard]] std::string staging() const { return staging_.string(); }
  [[nodiscard]] std::string path() const { return folder_.string(); }
  /// Moves the files to the result folder and returns their names, sorted. Signal files of an earlier run with other segments are removed.
  std::vector<std::string> commit();

private:
  void refuse_existing(const std::vector<std::string>& names) const;
  [[noreturn]] void fail(const std::string& why) const;
  std::filesystem::path folder_, staging_;
  bool is_overwriting_ = false;
};

} // namespace steplap
