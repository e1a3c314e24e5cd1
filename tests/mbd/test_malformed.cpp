// Every file of tests/data/malformed fails with exactly the messages that its own "# expect:" lines
// give ("# set:" lines are overrides; folders are cut off). Files *.inc are extended by others.
#include "mbd/io/reader.h"
#include "tests/mbd/small_catalogue.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

using namespace steplap;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> lines_after(const fs::path& file, const std::string& mark) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (line.rfind(mark, 0) == 0) lines.push_back(line.substr(mark.size()));
  return lines;
}

std::string without(std::string text, const std::string& part) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

std::vector<std::string> messages(const fs::path& file) {
  std::vector<std::string> texts;
  try {
    static_cast<void>(read_model(file.string(), testing::small_catalogue(), lines_after(file, "# set: ")));
  } catch (const ModelError& error) {
    for (const Diagnostic& d : error.diagnostics()) texts.push_back(without(d.text(), file.parent_path().string() + "/"));
  }
  return texts;
}

std::vector<fs::path> malformed_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(STEPLAP_TEST_DATA "/malformed"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace

TEST_CASE("malformed model files fail with the message they expect") {
  const std::vector<fs::path> files = malformed_files();
  CHECK(files.size() >= 100);
  for (const fs::path& file : files) {
    CAPTURE(file.filename().string());
    const std::vector<std::string> expected = lines_after(file, "# expect: ");
    CHECK_FALSE(expected.empty());
    CHECK(messages(file) == expected);
  }
}

TEST_CASE("a file that is not there") {
  CHECK_THROWS_WITH_AS(static_cast<void>(read_model("no_such.toml", testing::small_catalogue())),
                       "error: cannot read 'no_such.toml': No such file or directory", ModelError);
}

TEST_CASE("very many errors are cut short") {
  std::string text = "[simulation]\nstep = 1e-3\n";
  for (int i = 0; i < 1000; ++i) text += "[[body]]\nname = \"b" + std::to_string(i) + "\"\n";
  try {
    static_cast<void>(parse_model(text, "many.toml", testing::small_catalogue()));
    FAIL("no error");
  } catch (const ModelError& error) {
    CHECK(error.diagnostics().size() == 51);
    CHECK(error.diagnostics().back().text() == "many.toml: error: and 1950 more errors");
  }
}
