// Writes files completely or not at all. The content goes to a temporary file in the same folder, is flushed to disk, and the file is
// renamed.
#pragma once

#include "mbd/base/diagnostics.h"

#include <functional>
#include <string>
#include <string_view>

namespace steplap {

enum class IfExists { refuse, replace };

/// Writes `content` to the file `path`. Throws FileError if the file exists and `if_exists` is refuse, if the folder is not writable, or if
/// the disk is full. After an error the file at `path` is unchanged. The temporary file is always removed. A file that
/// is replaced keeps its permissions; a link to it stays.
void write_file(const std::string& path, const std::string& content, IfExists if_exists = IfExists::refuse);

using FileSink = std::function<void(std::string_view part)>;
/// Function that passes the content of a file to `put` part by part, so that it need not be in memory as a whole.
using FileContent = std::function<void(const FileSink& put)>;
void write_file(const std::string& path, const FileContent& content, IfExists if_exists = IfExists::refuse);

} // namespace steplap
