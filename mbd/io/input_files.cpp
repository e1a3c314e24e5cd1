#include "mbd/io/input_files.h"

#include "mbd/io/digest.h"
#include "mbd/io/read_input.h"

#include <algorithm>
#include <filesystem>

namespace steplap {

namespace {

thread_local InputFiles* listener = nullptr;

} // namespace

InputFiles::InputFiles() : outer_(listener) { listener = this; }
InputFiles::~InputFiles() { listener = outer_; }

void InputFiles::note(InputFile file) {
  if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(std::move(file));
}

void note_input(const std::string& path, const std::string& text, bool is_record) {
  if (listener) listener->note({path, sha256(text), text.size(), is_record});
}

std::string sha256_of_file(const std::string& path) {
  try {
    return sha256(read_input(path, {}));
  } catch (const ModelError&) {
    return "";
  }
}

std::string absolute_path(const InputFile& file) {
  std::error_code ignored;
  return is_standard_input(file.path) ? "" : std::filesystem::weakly_canonical(std::filesystem::absolute(file.path), ignored).string();
}

} // namespace steplap
