// Records which files a computation reads, with their checksums, so that results can identify their inputs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

struct InputFile {
  std::string path;   ///< path as given, relative to the working directory
  std::string sha256; ///< checksum of the content
  std::size_t bytes = 0;
  bool is_record = false; ///< true: table of numbers; false: document

  bool operator==(const InputFile&) const = default;
};

/// Records all files that are read in this thread while the object exists. If objects are nested, the inner one records a file and passes
/// it on to the outer one.
class InputFiles {
public:
  InputFiles();
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;
  ~InputFiles();

  /// Returns the files in the order in which they were first read, each once.
  [[nodiscard]] const std::vector<InputFile>& files() const { return files_; }
  void note(InputFile file);

private:
  std::vector<InputFile> files_;
  InputFiles* outer_;
};

/// Records in the current InputFiles, if there is one, that `text` was read from `path`. Called by all readers.
void note_input(const std::string& path, const std::string& text, bool is_record);

/// Returns the checksum of the file's present content; "" if it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::string& path);
/// Returns the absolute path with links resolved; "" for standard input.
[[nodiscard]] std::string absolute_path(const InputFile& file);

} // namespace steplap
