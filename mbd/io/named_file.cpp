#include "mbd/io/named_file.h"

#include "mbd/io/digest.h"
#include "mbd/io/input_files.h"
#include "mbd/io/read_input.h"

namespace steplap {

std::string read_named_file(const std::string& path, const Location& where, const std::string& noun, const std::string& wanted) {
  std::string text = read_input(path, where, noun);
  note_input(path, text, true);
  if (!wanted.empty() && sha256(text) != wanted)
    throw ModelError(where, noun + "'" + path + "' is not the one that was meant: its SHA-256 is " + sha256(text) +
                                ". Take the file of that time, or drop 'sha256' to take this one");
  return text;
}

} // namespace steplap
