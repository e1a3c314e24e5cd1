// Counts comments that begin as fragments ("Of …", "What …", "That which …", "The same as …"), which readers understand at the second
// reading only. The number may only fall. A comment begins where the line before it is no comment.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

constexpr int k_most_fragments = 0;

const std::vector<std::string> k_starts = {"Of ", "What ", "That which ", "The same as "};

// The text behind "//", "///" or "///<"; "" without a comment. Strings that hold "//" are rare and do no harm here.
std::string comment_of(const std::string& line) {
  const std::size_t at = line.find("//");
  if (at == std::string::npos) return "";
  const std::size_t text = line.find_first_not_of("/< ", at);
  return text == std::string::npos ? "" : line.substr(text);
}

bool is_fragment(const std::string& comment) {
  for (const std::string& start : k_starts)
    if (comment.starts_with(start)) return true;
  return false;
}

int fragments_in(std::istream& lines) {
  int count = 0;
  bool follows_comment = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    const bool is_whole_line = first != std::string::npos && line.compare(first, 2, "//") == 0;
    if (!(is_whole_line && follows_comment) && is_fragment(comment_of(line))) ++count;
    follows_comment = is_whole_line;
  }
  return count;
}

} // namespace

TEST_CASE("fewer comments begin as fragments, never more") {
  int count = 0, files = 0;
  for (const char* folder : {"mbd", "elements", "transformer", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(STEPLAP_SOURCE) / folder)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".h" && extension != ".js") continue;
      std::ifstream lines(entry.path());
      count += fragments_in(lines);
      ++files;
    }
  CHECK(files > 900);
  CHECK_MESSAGE(count <= k_most_fragments, count << " comments begin as fragments; write a subject and a verb instead");
}
