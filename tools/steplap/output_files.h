// Files that a command writes in addition to its messages. "-" is the standard output, which then contains that file and nothing else.
#pragma once

#include "tools/steplap/command.h"

#include <initializer_list>

namespace steplap {

/// An option that names an output file, and the file name given.
struct OutputFile {
  const char* option; ///< name of the option for error messages, "-o"
  std::optional<std::string> path;
};

[[nodiscard]] inline bool is_standard_output(const std::string& path) { return path == "-"; }

/// Throws UsageError, before anything is computed, if more than one file uses the standard input or output, or if "-" is given for a folder
/// or a store of results.
void refuse_wrong_streams(const Command& command);

/// Output files of one call of a command.
class OutputFiles {
public:
  /// Throws UsageError if two files, or a file and the tables of --json, use the standard output.
  OutputFiles(Console& console, std::initializer_list<OutputFile> files, bool is_overwriting = false);
  /// Returns true if the command may print messages: not with -q, and not if the standard output contains a file.
  [[nodiscard]] bool may_print() const { return may_print_; }
  /// Writes the whole file or nothing. Does nothing if no path was given. Throws FileError.
  void write(const std::optional<std::string>& path, const std::string& content) const;

private:
  Console& console_;
  bool is_overwriting_, may_print_;
};

} // namespace steplap
