// The folder of a record's results: all files appear in it together, or none does.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace steplap {

/// Files are written to a hidden folder on the same disk and moved at the end.
class RecordFolder {
public:
  /// Throws FileError: results stand in `folder` that may not be replaced, or it cannot be written.
  RecordFolder(const std::string& folder, bool is_overwriting);
  RecordFolder(const RecordFolder&) = delete;
  RecordFolder& operator=(const RecordFolder&) = delete;
  /// Without commit() nothing stays, neither a file nor a folder.
  ~RecordFolder();

  /// Where files are written until commit().
  [[nodiscard]] std::string staging() const { return staging_.string(); }
  [[nodiscard]] std::string path() const { return folder_.string(); }
  /// Moves the files and returns their names, sorted. An earlier signal in other segments goes, as it would stand beside the new one.
  std::vector<std::string> commit();

private:
  void refuse_existing(const std::vector<std::string>& names) const;
  [[noreturn]] void fail(const std::string& why) const;
  std::filesystem::path folder_, staging_;
  bool is_overwriting_ = false;
};

} // namespace steplap
