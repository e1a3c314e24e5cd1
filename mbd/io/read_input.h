// A file that a user names, read as a whole: a regular file, or what comes through a pipe that the shell or the caller has
// opened. Devices and named pipes are refused: they have no end, or none that comes by itself.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>

namespace steplap {

/// Content of `path`; "-" and /dev/stdin: standard input, /dev/fd/N: what is open there. `noun` is what messages call it
/// ("the record "), or "". Throws ModelError at `where`: it cannot be read, is none of those, or is larger than 4 GB.
[[nodiscard]] std::string read_input(const std::string& path, const Location& where, const std::string& noun = "");

[[nodiscard]] bool is_standard_input(const std::string& path);
/// What messages call the file: "<standard input>", or the path itself.
[[nodiscard]] std::string shown_input(const std::string& path);

} // namespace steplap
