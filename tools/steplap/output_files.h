// Files that a command writes besides what it says. "-" is the standard output, which then holds that file and nothing else.
#pragma once

#include "tools/steplap/command.h"

#include <initializer_list>

namespace steplap {

/// An option that takes a file to write, and what was given.
struct OutputFile {
  const char* option; ///< "-o", for messages
  std::optional<std::string> path;
};

[[nodiscard]] inline bool is_standard_output(const std::string& path) { return path == "-"; }

/// Throws UsageError, before anything is computed, for what the standard input and output cannot do: files to read and to write are
/// "-" where only one can be, or where a folder or a store of results is meant.
void refuse_wrong_streams(const Command& command);

/// The files of one call of a command.
class OutputFiles {
public:
  /// Throws UsageError if two files go to the standard output, or one with the tables of --json.
  OutputFiles(Console& console, std::initializer_list<OutputFile> files, bool is_overwriting = false);
  /// May the command say what it has to say? Not with -q, and not where the standard output holds a file.
  [[nodiscard]] bool has_words() const { return has_words_; }
  /// Writes what `file` was given for: a whole file or nothing. Does nothing where no path was given. Throws FileError.
  void write(const std::optional<std::string>& path, const std::string& content) const;

private:
  Console& console_;
  bool is_overwriting_, has_words_;
};

} // namespace steplap
