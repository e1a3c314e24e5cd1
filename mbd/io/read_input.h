// Reads a file named by a user as a whole: a regular file, or a pipe that the shell or the caller has opened. Devices and named pipes are
// refused, because reading might never end.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>

namespace steplap {

/// Returns the content of the file `path`; "-" and /dev/stdin are standard input, /dev/fd/N an open descriptor. `noun` precedes the path in
/// messages: "the record ", or "". Throws ModelError at `where` if the file cannot be read, is of another type, or is larger than 4 GB.
[[nodiscard]] std::string read_input(const std::string& path, const Location& where, const std::string& noun = "");

[[nodiscard]] bool is_standard_input(const std::string& path);
/// Returns the file's name in messages: "<standard input>", or the path itself.
[[nodiscard]] std::string shown_input(const std::string& path);

} // namespace steplap
