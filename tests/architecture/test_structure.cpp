// Compares docs/design/structure.md with the sources: each `path` exists, each `function()` occurs in a file named in the same line, and
// folders are about as large as stated. Lines of the pages' scripts and styles are no longer than those of C++.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path k_source = STEPLAP_SOURCE;

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// What stands in a line between backticks.
std::vector<std::string> quoted_in(const std::string& line) {
  std::vector<std::string> quoted;
  for (std::size_t begin = line.find('`'); begin != std::string::npos;) {
    const std::size_t end = line.find('`', begin + 1);
    if (end == std::string::npos) break;
    quoted.push_back(line.substr(begin + 1, end - begin - 1));
    begin = line.find('`', end + 1);
  }
  return quoted;
}

bool is_path(const std::string& text) {
  return text.find(' ') == std::string::npos &&
         (text.find('/') != std::string::npos || text.ends_with(".h") || text.ends_with(".cpp") || text.ends_with(".md"));
}

bool occurs(const std::string& function, const std::string& text) {
  for (std::size_t at = text.find(function + "("); at != std::string::npos; at = text.find(function + "(", at + 1))
    if (at == 0 || !(std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_')) return true;
  return false;
}

// What is wrong with a line, "" if nothing is.
std::string problem_of(const std::string& line, int& paths, int& functions) {
  std::string problem;
  std::vector<std::string> texts;
  const std::vector<std::string> quoted = quoted_in(line);
  for (const std::string& name : quoted)
    if (is_path(name)) {
      ++paths;
      if (!fs::exists(k_source / name)) problem += name + " does not exist; ";
      else if (fs::is_regular_file(k_source / name)) texts.push_back(text_of(k_source / name));
    }
  for (const std::string& name : quoted)
    if (name.ends_with("()")) {
      ++functions;
      const std::string bare = name.substr(0, name.size() - 2);
      if (std::none_of(texts.begin(), texts.end(), [&](const std::string& text) { return occurs(bare, text); }))
        problem += name + " occurs in no file of the line; ";
    }
  return problem;
}

// Lines of a folder's own sources, without its subfolders.
long lines_in(const fs::path& folder) {
  long lines = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".cpp" && ending != ".h" && ending != ".js" && ending != ".css" && ending != ".html") continue;
    const std::string text = text_of(entry.path());
    lines += std::count(text.begin(), text.end(), '\n');
  }
  return lines;
}

} // namespace

TEST_CASE("docs/design/structure.md names files and functions that there are") {
  std::ifstream page(k_source / "docs/design/structure.md");
  REQUIRE(page);
  int paths = 0, functions = 0, number = 0;
  bool is_code = false;
  for (std::string line; std::getline(page, line);) {
    ++number;
    if (line.starts_with("```")) is_code = !is_code;
    if (is_code || line.starts_with("```")) continue;
    const std::string problem = problem_of(line, paths, functions);
    CHECK_MESSAGE(problem.empty(), "line " << number << ": " << problem);
  }
  CHECK(paths > 60); // it has read the page
  CHECK(functions > 40);
}

TEST_CASE("a wrong name is noticed") {
  int paths = 0, functions = 0;
  CHECK(problem_of("`mbd/trust/judge.cpp`: `judge()`", paths, functions).empty());
  CHECK(problem_of("`mbd/trust/judge.cpp`: `judges()`", paths, functions) == "judges() occurs in no file of the line; ");
  CHECK(problem_of("`mbd/trust/judge.cpp`: `udge()`", paths, functions) == "udge() occurs in no file of the line; ");
  CHECK(problem_of("`mbd/trust/jury.cpp`", paths, functions) == "mbd/trust/jury.cpp does not exist; ");
}

// A folder may grow by a quarter before its row has to be updated: the numbers only distinguish large folders from small ones.
TEST_CASE("folders are about as large as docs/design/structure.md says") {
  std::ifstream page(k_source / "docs/design/structure.md");
  int folders = 0;
  for (std::string line; std::getline(page, line);) {
    const std::vector<std::string> quoted = quoted_in(line);
    const std::size_t last = line.find_last_of('|'),
                      before = last == std::string::npos || last == 0 ? last : line.find_last_of('|', last - 1);
    if (!line.starts_with("| `") || before == std::string::npos || quoted.empty() || !quoted.front().ends_with('/')) continue;
    const long said = std::atol(line.substr(before + 1).c_str());
    if (said == 0) continue;
    ++folders;
    const double share = static_cast<double>(lines_in(k_source / quoted.front())) / static_cast<double>(said);
    CHECK_MESSAGE((share > 0.8 && share < 1.25), quoted.front() << " has " << lines_in(k_source / quoted.front()) << " lines");
  }
  CHECK(folders > 20);
}

// clang-format leaves long texts as they are, and styles alone.
TEST_CASE("no line of the pages' scripts and styles has more than 140 characters") {
  constexpr long k_longest = 140; // ColumnLimit of .clang-format
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(k_source / "tools/pages")) {
    const fs::path& path = entry.path();
    const bool is_script = path.extension() == ".js" || path.extension() == ".css";
    if (!is_script || path.parent_path().filename() == "plotly") continue; // a library as it is published
    ++files;
    std::ifstream file(path);
    long number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      const auto is_first_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }; // of a character in UTF-8
      CHECK_MESSAGE(std::count_if(line.begin(), line.end(), is_first_byte) <= k_longest, path.filename().string() << ":" << number);
    }
  }
  CHECK(files > 50);
}
