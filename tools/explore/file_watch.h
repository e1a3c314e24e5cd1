// Whether files have been changed, by looking at them again: editors replace files in many ways, and what counts is what stands there.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace steplap {

/// Looks at a list of files.
class FileWatch {
public:
  /// From now on these. Of files that were watched before, a change that was not told yet still will be.
  void watch(const std::vector<std::string>& files);
  /// True once after a change, when the files have looked the same at two calls: what is being written is not looked at half.
  [[nodiscard]] bool has_changed();

private:
  std::map<std::string, std::string> known_, before_; ///< path: size, time, identity; "" of a file that is not there
};

} // namespace steplap
