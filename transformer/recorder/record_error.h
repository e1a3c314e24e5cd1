// Error in a recorder's file, with its location and the option that resolves it.
#pragma once

#include "mbd/base/diagnostics.h"

#include <cstddef>
#include <string>

namespace steplap {

/// Error with the message "FILE:LINE:COLUMN: cause. Remedy." Exit code 2, as for all invalid files.
class RecordError : public FileError {
public:
  /// Line and column count from 1; 0 means the whole file. `what` contains cause and remedy as sentences.
  RecordError(const std::string& file, std::size_t line, std::size_t column, const std::string& what);

  /// Returns the column in bytes, from 1; 0 for the whole line.
  [[nodiscard]] std::size_t column() const { return column_; }

private:
  std::size_t column_ = 0;
};

} // namespace steplap
