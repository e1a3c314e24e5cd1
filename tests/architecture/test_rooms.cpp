// The rooms of the source tree: each includes what stands before it, never what stands behind; no header leads back to
// itself; headers that cost seconds of compiling are each included by one file of the product.
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
const std::vector<std::string> k_rooms = {
    "mbd/math",     "mbd/base",        "mbd/formula",    "mbd/algebra",    "mbd/tape",    "mbd/model",     "mbd/system", "mbd/dynamics",
    "mbd/friction", "mbd/integrators", "mbd/events",     "mbd/simulation", "mbd/rest",    "mbd/vibration", "mbd/trust",  "mbd/acceptance",
    "mbd/io",       "record",          "elements/patch", "elements",       "transformer", "run",           "report",     "explore/page",
    "explore",      "python",          "study",          "assess",         "tools"};

// Headers of libraries, of which one file of the product knows.
const std::vector<std::string> k_heavy = {
    "toml++/", "udunits2", "CLI/", "openssl/", "muParser", "sqlite3", "mpi.h", "asmjit/", "fmt/", "boost/beast", "unsupported/Eigen/FFT"};

// Rooms with doors: the headers that other rooms may include, and why. The others are the room's own affair.
struct Door {
  std::string header, why;
  std::string of = {}; ///< the only room that it leads to; empty: any
};
const std::map<std::string, std::vector<Door>> k_doors = {
    {"mbd/rest",
     {{"assembly.h", "puts bodies where joints hold"},
      {"start.h", "where a run begins"},
      {"equilibrium.h", "a pose at rest"},
      {"ramped_rest.h", "a rest under loads that grow"},
      {"freedom.h", "motions that nothing holds"},
      {"statics.h", "forces, rows and stiffness of a pose at rest"},
      {"tangent.h", "the motions that rows leave"},
      {"bordered_system.h", "stiffness with rows, sparse", "mbd/vibration"},
      {"sparse_rows.h", "gradients of rows, sparse", "mbd/vibration"},
      {"spread.h", "starts of an iteration", "mbd/vibration"}}},
    {"mbd/vibration", {{"modes.h", "frequencies and shapes"}}},
    {"mbd/trust",
     {{"balance.h", "what stays in place only because nothing disturbs it"},
      {"global_error.h", "estimated errors of a run"},
      {"accuracy_study.h", "convergence"},
      {"cross_check.h", "method against method"},
      {"audit.h", "a run against the laws of its friction"},
      {"event_match.h", "events of two runs in pairs"}}},
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
  for (const char* top : {"mbd", "record", "elements", "transformer", "run", "report", "explore", "python", "study", "assess", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h") sources.push_back(source_of(root, entry.path()));
  return sources;
}

// What cmake/install.cmake leaves out.
const std::vector<std::string> k_not_installed = {
    "record/", "tools/", "study/", "report/", "explore/", "python/", "assess/", "run/ordered_json.h", "run/summary.h"};

// The longest room that the path lies in; −1: none.
int room_of(const std::string& path) {
  int best = -1;
  for (std::size_t i = 0; i < k_rooms.size(); ++i) {
    const bool is_inside = path.starts_with(k_rooms[i] + "/");
    if (is_inside && (best < 0 || k_rooms[i].size() > k_rooms[static_cast<std::size_t>(best)].size())) best = static_cast<int>(i);
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

TEST_CASE("every source stands in a room and includes only what stands before it") {
  int arrows = 0;
  for (const Source& source : all_sources()) {
    const int room = room_of(source.path);
    CHECK_MESSAGE(room >= 0, source.path << " stands in no room");
    for (const std::string& name : source.own) {
      if (name.find('/') == std::string::npos) continue; // its neighbour
      const int other = room_of(name);
      CHECK_MESSAGE(other >= 0, source.path << " includes " << name << ", which is in no room");
      CHECK_MESSAGE(other <= room, source.path << " includes " << name << ", which stands behind it");
      arrows += other < room;
    }
  }
  CHECK(arrows > 200); // it has looked at the tree
}

TEST_CASE("rest, vibration and trust are entered by their doors alone") {
  std::set<std::string> used;
  for (const Source& source : all_sources()) {
    const int room = room_of(source.path);
    if (room < 0) continue;
    for (const std::string& name : source.own) {
      const int other = room_of(name);
      if (other < 0 || other == room) continue;
      const auto doors = k_doors.find(k_rooms[static_cast<std::size_t>(other)]);
      if (doors == k_doors.end()) continue;
      const auto door =
          std::find_if(doors->second.begin(), doors->second.end(), [&](const Door& d) { return doors->first + "/" + d.header == name; });
      CHECK_MESSAGE(door != doors->second.end(), source.path << " includes " << name << ", which is no door of its room");
      if (door == doors->second.end()) continue;
      used.insert(name);
      const bool may_enter = door->of.empty() || door->of == k_rooms[static_cast<std::size_t>(room)];
      CHECK_MESSAGE(may_enter, source.path << " includes " << name << ", a door to " << door->of << " alone");
    }
  }
  for (const auto& [room, doors] : k_doors)
    for (const Door& door : doors)
      CHECK_MESSAGE(used.count(room + "/" + door.header) == 1, room << "/" << door.header << " is a door that nobody uses");
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
      CHECK_MESSAGE((!name.starts_with("CGAL/") || source.path.starts_with("elements/patch/exact_")), source.path);
}
