// No two types of the program have one name. The compiler sees one source at a time and takes either for the other: an implicit
// constructor or destructor that it does not write out where it is used is then that of a type with other members. Optimised builds
// hide that by chance.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> k_folders = {"mbd", "elements", "transformer", "tools"};

using Definitions = std::map<std::string, std::set<std::string>>; // files by the type's full name

/// Namespaces begin and end at the first column; types of unnamed ones are each file's own, and so are members of types.
void collect(std::istream& lines, const std::string& file, Definitions& out) {
  static const std::regex opens(R"(^(?:inline )?namespace ?([\w:]*) ?\{$)"), closes(R"(^\} // namespace)");
  static const std::regex defines(
      R"(^(?:template ?<.*> ?)?(?:struct|class|union|enum class|enum) (?:alignas\(\w+\) )?(\w+)(?: final)?(?: : [^;]*)?\s*\{)");
  std::vector<std::string> names;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, match, opens)) names.push_back(match[1]);
    else if (std::regex_search(line, closes) && !names.empty()) names.pop_back();
    else if (std::find(names.begin(), names.end(), "") == names.end() && std::regex_search(line, match, defines)) {
      std::string name;
      for (const std::string& n : names) name += n + "::";
      out[name + match[1].str()].insert(file);
    }
  }
}

Definitions all_definitions() {
  const fs::path root = STEPLAP_SOURCE;
  Definitions out;
  for (const std::string& folder : k_folders) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".h" && ending != ".cpp") continue;
      std::ifstream lines(entry.path());
      collect(lines, fs::relative(entry.path(), root).generic_string(), out);
    }
  }
  return out;
}

} // namespace

TEST_CASE("no two types have one name") {
  const Definitions all = all_definitions();
  CHECK(all.size() > 400); // else they are not found
  for (const auto& [name, files] : all) {
    std::string places;
    for (const std::string& file : files) places += " " + file;
    CHECK_MESSAGE(files.size() == 1, name << ":" << places);
  }
}

TEST_CASE("a type that stands twice is seen") {
  Definitions out;
  std::istringstream one("namespace a {\nstruct Place {\n};\nnamespace {\nstruct Own {\n};\n} // namespace\n} // namespace a\n");
  std::istringstream two(
      "namespace a {\nclass Place final : Base {\n};\nnamespace {\nstruct Own {\n};\n} // namespace\n} // namespace a\n");
  collect(one, "one", out);
  collect(two, "two", out);
  CHECK(out.at("a::Place").size() == 2);
  CHECK(out.size() == 1);
}
