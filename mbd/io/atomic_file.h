// Files that are either there as a whole or not at all: written under a temporary name in the same
// folder, brought to disk, then renamed.
#pragma once

#include "mbd/base/diagnostics.h"

#include <functional>
#include <string>
#include <string_view>

namespace steplap {

enum class IfExists { refuse, replace };

/// Writes the whole content. Throws FileError: the file exists and may not be replaced, the folder
/// cannot be written, the disk is full. The temporary file is removed in every case, and what stood
/// at `path` before stays as it was.
void write_file(const std::string& path, const std::string& content, IfExists if_exists = IfExists::refuse);

using FileSink = std::function<void(std::string_view part)>;
/// Gives a content part by part, so that it need not be in memory.
using FileContent = std::function<void(const FileSink& put)>;
void write_file(const std::string& path, const FileContent& content, IfExists if_exists = IfExists::refuse);

} // namespace steplap
