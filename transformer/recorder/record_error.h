// A recorder's file that cannot be used as it stands, with its place and the option that settles it.
#pragma once

#include "mbd/base/diagnostics.h"

#include <cstddef>
#include <string>

namespace steplap {

/// "FILE:LINE:COLUMN: cause. Remedy." Exit code 2, as for every file that is not what it should be.
class RecordError : public FileError {
public:
  /// Line and column count from 1; 0: the file as a whole. `what`: cause and remedy in whole sentences.
  RecordError(const std::string& file, std::size_t line, std::size_t column, const std::string& what);

  /// In bytes of the line, from 1; 0 if the line as a whole is meant.
  [[nodiscard]] std::size_t column() const { return column_; }

private:
  std::size_t column_ = 0;
};

} // namespace steplap
