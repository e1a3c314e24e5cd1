// Which files were read, and what they held: for results that say what they were made of.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

struct InputFile {
  std::string path;   ///< as it was named, relative to the folder of the process
  std::string sha256; ///< of what it held
  std::size_t bytes = 0;
  bool is_record = false; ///< a table of numbers; else a document

  bool operator==(const InputFile&) const = default;
};

/// While it lives it notes every document and every record that is read on this thread. One within another takes what
/// is read during its own life, until it hands it on.
class InputFiles {
public:
  InputFiles();
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;
  ~InputFiles();

  /// In the order in which they were read first, each once.
  [[nodiscard]] const std::vector<InputFile>& files() const { return files_; }
  void note(InputFile file);

private:
  std::vector<InputFile> files_;
  InputFiles* outer_;
};

/// Of readers: `text` was read from `path`.
void note_input(const std::string& path, const std::string& text, bool is_record);

/// What the file holds now; "" if it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::string& path);
/// Absolute, links resolved; "" of standard input.
[[nodiscard]] std::string absolute_path(const InputFile& file);

} // namespace steplap
