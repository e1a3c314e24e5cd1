// Writes files completely or not at all: under a temporary name in the same folder, flushed to disk, then renamed.
#pragma once

#include "mbd/base/diagnostics.h"

#include <functional>
#include <string>
#include <string_view>

namespace steplap {

enum class IfExists { refuse, replace };

/// Writes the whole content. Throws FileError if the file exists and `if_exists` is refuse, if the folder is not writable, or if the disk
/// is full. On failure the file at `path` stays unchanged. The temporary file is always removed.
void write_file(const std::string& path, const std::string& content, IfExists if_exists = IfExists::refuse);

using FileSink = std::function<void(std::string_view part)>;
/// Function that passes the content to a sink part by part, so that it need not be in memory as a whole.
using FileContent = std::function<void(const FileSink& put)>;
void write_file(const std::string& path, const FileContent& content, IfExists if_exists = IfExists::refuse);

} // namespace steplap
