// Reads a file that a field of a model names: a table of numbers, a drawing.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>

namespace steplap {

/// Returns the content and records the file as an input (input_files.h); `noun` is for messages ("the record "). Throws ModelError at `where`
/// if it cannot be read or, with `wanted` not empty, if its SHA-256 differs from it.
[[nodiscard]] std::string read_named_file(const std::string& path, const Location& where, const std::string& noun,
                                          const std::string& wanted);

} // namespace steplap
