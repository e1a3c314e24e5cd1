// Every model of tests/data/malformed.txt fails with exactly the messages that its own "# expect:" lines give ("# set:" lines are
// overrides; folders are cut off). A line "=== NAME" begins a file; files *.inc and *.csv are read by models.
#include "mbd/io/reader.h"
#include "tests/mbd/small_catalogue.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

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

// The files of tests/data/malformed.txt in a folder of their own.
class MalformedFiles {
public:
  MalformedFiles() : folder_(fs::temp_directory_path() / ("steplap_malformed_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    std::ifstream all(STEPLAP_TEST_DATA "/malformed.txt");
    std::ofstream file;
    const std::string mark = "=== ";
    for (std::string line; std::getline(all, line);) {
      if (line.rfind(mark, 0) != 0) {
        file << line << '\n';
        continue;
      }
      const fs::path path = folder_ / line.substr(mark.size());
      file.close();
      file.open(path);
      if (path.extension() == ".toml") models.push_back(path);
    }
  }
  MalformedFiles(const MalformedFiles&) = delete;
  MalformedFiles& operator=(const MalformedFiles&) = delete;
  ~MalformedFiles() { fs::remove_all(folder_); }

  std::vector<fs::path> models;

private:
  fs::path folder_;
};

} // namespace

TEST_CASE("malformed model files fail with the message they expect") {
  const MalformedFiles files;
  CHECK(files.models.size() == 138);
  for (const fs::path& file : files.models) {
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
