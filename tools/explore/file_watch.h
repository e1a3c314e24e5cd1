// Detects changes of files by polling, because editors replace files in many different ways.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace steplap {

/// Observes a list of files.
class FileWatch {
public:
  /// Sets the files to be watched. A change of the previous files that was not reported yet is still reported.
  void watch(const std::vector<std::string>& files);
  /// Returns true once after a change, when two consecutive calls have found the same files, so that incompletely written files are not
  /// read.
  [[nodiscard]] bool has_changed();

private:
  /// state of each file when last reported, and at the last call: size, time and inode; "" if it does not exist
  std::map<std::string, std::string> known_, before_;
};

} // namespace steplap
