// Dependencies of the source tree. A module is a folder, or a file pair that needs a place of its own in the order. Each module
// includes only modules that precede it in k_modules. No header includes itself through others. Headers that take seconds to compile
// are included by one file of the product.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

// In the order of the data: a model is read, compiled, moved, asked.
const std::vector<std::string> k_modules = {"mbd/base",
                                            "mbd/tape",
                                            "mbd/formula",
                                            "mbd/model",
                                            "mbd/system",
                                            "mbd/dynamics",
                                            "mbd/integrators",
                                            "mbd/events",
                                            "mbd/simulation",
                                            "mbd/rest",
                                            "mbd/trust",
                                            "mbd/io",
                                            "mbd/run", //
                                            "elements/step_lap/patch",
                                            "elements",
                                            "elements/machinery",
                                            "elements/step_lap",
                                            "elements/catalog",
                                            "elements/views", //
                                            "transformer/recorder",
                                            "transformer/core",
                                            "transformer/decision",
                                            "transformer/catalog",
                                            "transformer/program", //
                                            "tools/pages/run",
                                            "tools/pages/explore",
                                            "tools/pages/study",
                                            "tools/pages",
                                            "tools/explore",
                                            "tools/python",
                                            "tools/study",
                                            "tools/assess",
                                            "tools/steplap",
                                            "tools/study/program",
                                            "tools"};

// Headers of libraries, of which one file of the product knows.
const std::vector<std::string> k_heavy = {"toml++/", "udunits2", "CLI/",    "openssl/", "muParser",
                                          "sqlite3", "mpi.h",    "asmjit/", "fmt/",     "boost/beast"};

// Folders of which others include only some headers: their public ones, each with what it is for.
using PublicHeaders = std::map<std::string, std::string>;
const std::map<std::string, PublicHeaders> k_public_headers = {
    {"mbd/rest",
     {{"assembly.h", "puts bodies where joints hold"},
      {"start.h", "where a run begins"},
      {"equilibrium.h", "a pose at rest"},
      {"ramped_rest.h", "a rest under loads that grow"},
      {"freedom.h", "motions that nothing holds"},
      {"statics.h", "forces, rows and stiffness of a pose at rest"},
      {"tangent.h", "the motions that rows leave"},
      {"free_vibration.h", "eigenvalues of small vibrations that nothing binds"},
      {"modes.h", "frequencies and shapes of small vibrations"}}},
    {"mbd/trust",
     {{"accuracy_study.h", "convergence"},
      {"audit.h", "a run against the laws of its friction"},
      {"balance.h", "what stays in place only because nothing disturbs it"},
      {"criteria.h", "one limit against the extreme of its channel"},
      {"cross_check.h", "method against method"},
      {"element_judgement.h", "limits that a kind of element has of its own"},
      {"global_error.h", "estimated errors of a run"},
      {"joint_assessment.h", "figures and verdict of a joint that is held by friction"},
      {"judge.h", "all criteria of a run"},
      {"judgement.h", "the verdict and its reasons"},
      {"weighed_errors.h", "verdicts within the error of their values"}}},
};

struct Source {
  std::string path;
  std::vector<std::string> own, foreign; ///< what it includes
};

// What follows #include in quotes or in angle brackets.
Source source_of(const fs::path& root, const fs::path& file) {
  Source source{fs::relative(file, root).generic_string(), {}, {}};
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("#include ")) continue;
    const char end = line[9] == '<' ? '>' : '"';
    const std::string name = line.substr(10, line.find(end, 10) - 10);
    (end == '>' ? source.foreign : source.own).push_back(name);
  }
  return source;
}

std::vector<Source> all_sources() {
  const fs::path root = STEPLAP_SOURCE;
  std::vector<Source> sources;
  for (const char* top : {"mbd", "elements", "transformer", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h") sources.push_back(source_of(root, entry.path()));
  return sources;
}

// What cmake/install.cmake leaves out.
const std::vector<std::string> k_not_installed = {"transformer/recorder/", "transformer/decision/", "tools/", "mbd/run/ordered_json.h",
                                                  "mbd/run/summary.h"};

// Index of the innermost module that holds the path; −1 if there is none.
int module_of(const std::string& path) {
  int best = -1;
  for (std::size_t i = 0; i < k_modules.size(); ++i) {
    const bool is_inside = path.starts_with(k_modules[i] + "/") || path.starts_with(k_modules[i] + ".");
    if (is_inside && (best < 0 || k_modules[i].size() > k_modules[static_cast<std::size_t>(best)].size())) best = static_cast<int>(i);
  }
  return best;
}

// A way from `path` back to a header that is being followed, "" if there is none.
std::string circle_from(const std::string& path, const std::map<std::string, std::vector<std::string>>& includes,
                        std::vector<std::string>& way, std::set<std::string>& done) {
  if (const auto met = std::find(way.begin(), way.end(), path); met != way.end()) {
    std::string text;
    for (auto step = met; step != way.end(); ++step) text += *step + " -> ";
    return text + path;
  }
  if (!done.insert(path).second) return "";
  way.push_back(path);
  if (const auto found = includes.find(path); found != includes.end())
    for (const std::string& next : found->second)
      if (std::string circle = circle_from(next, includes, way, done); !circle.empty()) return circle;
  way.pop_back();
  return "";
}

} // namespace

TEST_CASE("every source belongs to a module and includes only modules before it") {
  int dependencies = 0;
  for (const Source& source : all_sources()) {
    const int module = module_of(source.path);
    CHECK_MESSAGE(module >= 0, source.path << " belongs to no module");
    for (const std::string& name : source.own) {
      if (name.find('/') == std::string::npos) continue; // its neighbour
      const int other = module_of(name);
      CHECK_MESSAGE(other >= 0, source.path << " includes " << name << ", which belongs to no module");
      CHECK_MESSAGE(other <= module, source.path << " includes " << name << ", which comes after it in the order of modules");
      dependencies += other < module;
    }
  }
  CHECK(dependencies > 200); // it has looked at the tree
}

TEST_CASE("other folders include only the public headers of rest and trust") {
  std::set<std::string> used;
  for (const Source& source : all_sources()) {
    const int module = module_of(source.path);
    if (module < 0) continue;
    for (const std::string& name : source.own) {
      const int other = module_of(name);
      if (other < 0 || other == module) continue;
      const std::string& folder = k_modules[static_cast<std::size_t>(other)];
      const auto headers = k_public_headers.find(folder);
      if (headers == k_public_headers.end()) continue;
      CHECK_MESSAGE(headers->second.contains(name.substr(folder.size() + 1)),
                    source.path << " includes " << name << ", which is not a public header of " << folder);
      used.insert(name);
    }
  }
  for (const auto& [folder, headers] : k_public_headers)
    for (const auto& [header, purpose] : headers)
      CHECK_MESSAGE(used.contains(folder + "/" + header), "no other folder includes " << folder << "/" << header);
}

TEST_CASE("no header leads back to itself") {
  std::map<std::string, std::vector<std::string>> includes;
  for (const Source& source : all_sources())
    if (source.path.ends_with(".h")) includes[source.path] = source.own;
  std::set<std::string> done;
  for (const auto& [path, own] : includes) {
    std::vector<std::string> way;
    CHECK_MESSAGE(circle_from(path, includes, way, done) == "", "headers in a circle");
  }
}

TEST_CASE("the circle of headers is found where there is one") {
  const std::map<std::string, std::vector<std::string>> includes{{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}};
  std::set<std::string> done;
  std::vector<std::string> way;
  CHECK(circle_from("a", includes, way, done) == "b -> c -> b");
}

// Whoever uses the installed library needs the packages of no other.
TEST_CASE("headers of the library include no other maker's than Eigen's") {
  int headers = 0;
  for (const Source& source : all_sources()) {
    const bool is_installed = std::none_of(k_not_installed.begin(), k_not_installed.end(),
                                           [&](const std::string& start) { return source.path.starts_with(start); });
    if (!source.path.ends_with(".h") || !is_installed) continue;
    ++headers;
    for (const std::string& name : source.foreign) { // those of the standard library have neither folder nor ending
      const bool is_foreign = name.find_first_of("/.") != std::string::npos && !name.starts_with("Eigen/");
      CHECK_MESSAGE(!is_foreign, source.path << " includes " << name);
    }
  }
  CHECK(headers > 80);
}

TEST_CASE("a heavy header is known to one file") {
  for (const std::string& heavy : k_heavy) {
    std::vector<std::string> users;
    for (const Source& source : all_sources())
      if (std::any_of(source.foreign.begin(), source.foreign.end(), [&](const std::string& name) { return name.starts_with(heavy); }))
        users.push_back(source.path);
    CAPTURE(heavy);
    // MPI is begun by a program and used by a library.
    CHECK(users.size() == (heavy == "mpi.h" ? 2 : 1));
    CHECK(users.front().ends_with(".cpp"));
  }
  for (const Source& source : all_sources()) // CGAL has many headers
    for (const std::string& name : source.foreign)
      CHECK_MESSAGE((!name.starts_with("CGAL/") || source.path.starts_with("elements/step_lap/patch/exact_")), source.path);
}
