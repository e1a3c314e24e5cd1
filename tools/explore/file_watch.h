// Detects changes of files by polling, because editors replace files in many different ways.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace steplap {

/// Observes a list of files.
class FileWatch {
public:
  /// Sets the files to observe. A change of previously observed files that has not been reported yet is still reported.
  void watch(const std::vector<std::string>& files);
  /// Returns true once after a change, as soon as two successive calls have found the files equal, so that incomplete files are not read.
  [[nodiscard]] bool has_changed();

private:
  std::map<std::string, std::string> known_, before_; ///< path: size, time and identity; "" if the file does not exist
};

} // namespace steplap
