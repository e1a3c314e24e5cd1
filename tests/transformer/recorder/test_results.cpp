// The program on recorders' files: results appear all together, or not at all.
#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// A folder of its own, gone at the end.
class Place {
public:
  Place() : path_(fs::temp_directory_path() / ("steplap_record_test_" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Place() { fs::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name, std::ios::binary) << text; }
  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path_ / name).rdbuf();
    return text.str();
  }
  int record(const std::string& arguments) const {
    const int status =
        std::system(("cd '" + path_.string() + "' && '" STEPLAP_PROGRAM "' record " + arguments + " > screen.txt 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string screen() const { return read("screen.txt"); }
  bool has(const std::string& name) const { return fs::exists(path_ / name); }
  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_ / folder)) names.insert(entry.path().filename().string());
    return names;
  }

private:
  fs::path path_;
};

std::string rows(int from, int to) {
  std::string text;
  for (int i = from; i < to; ++i) text += std::to_string(0.01 * i) + ",0.1,0.2,1.0\n";
  return text;
}
const std::string k_names = "Time[s],Ax[g],Ay[g],Az[g]\n";

} // namespace

TEST_CASE("a file that is read leaves its results, and a second reading replaces them only if it is told to") {
  const Place place;
  place.write("good.csv", k_names + rows(0, 100) + rows(200, 300));
  REQUIRE_MESSAGE(place.record("good.csv --gravity none -o out/deep/") == 0, place.screen());
  const std::set<std::string> two = {"events.csv", "record.json", "shock_spectra.csv", "signal_001.csv", "signal_002.csv"};
  CHECK(place.files("out/deep") == two);
  CHECK(place.record("good.csv --gravity none -o out/deep") == 2);
  CHECK(place.screen().find("--force") != std::string::npos);
  place.write("good.csv", k_names + rows(0, 100));
  REQUIRE_MESSAGE(place.record("good.csv --gravity none -o out/deep --force") == 0, place.screen());
  CHECK(place.files("out/deep") ==
        std::set<std::string>{"events.csv", "record.json", "shock_spectra.csv", "signal.csv"}); // no segments of the file before
}

TEST_CASE("a file that is refused halfway leaves nothing") {
  const Place place;
  place.write("good.csv", k_names + rows(0, 100));
  place.write("bad.csv", k_names + rows(0, 60) + rows(100, 9000) + "90.5,abc,0.2,1.0\n");
  CHECK(place.record("bad.csv --gravity none -o out") == 2);
  CHECK(place.screen().find("bad.csv:8962:6: 'abc'") != std::string::npos);
  CHECK_FALSE(place.has("out"));
  CHECK(place.record("good.csv bad.csv --gravity none -o out") == 2);
  CHECK_FALSE(place.has("out"));
  CHECK(place.record("good.csv --event 3 --gravity none -o out") == 2);
  CHECK_FALSE(place.has("out"));
  REQUIRE(place.record("good.csv --gravity none -o out") == 0);
  const std::string before = place.read("out/signal.csv");
  CHECK(place.record("bad.csv --gravity none -o out --force") == 2);
  CHECK(place.files("out") == std::set<std::string>{"events.csv", "record.json", "shock_spectra.csv", "signal.csv"});
  CHECK(place.read("out/signal.csv") == before);
}

TEST_CASE("two files of one name are not written to one folder") {
  const Place place;
  place.write("a.csv", k_names + rows(0, 100));
  place.write("a.txt", k_names + rows(0, 100));
  CHECK(place.record("a.csv a.txt --gravity none -o out") == 2);
  CHECK_FALSE(place.has("out"));
}

TEST_CASE("gravity that would count as a shock is asked for: no event is listed, and no file written, before it is said what it is") {
  const Place place;
  REQUIRE(place.record("--make endaq shock.csv") == 0);
  REQUIRE(place.record("shock.csv") == 0);
  CHECK(place.screen().find("Events are not listed: axis z reads 1 g at rest") != std::string::npos);
  CHECK(place.screen().find("peak g") == std::string::npos);
  CHECK(place.record("shock.csv -o out") == 2);
  CHECK(place.screen().find("--gravity z") != std::string::npos);
  CHECK_FALSE(place.has("out"));
  REQUIRE(place.record("shock.csv --threshold 2.5 --gravity none") == 0); // as it is: gravity alone does not reach it
  CHECK(place.screen().find("1 event beyond 2.5 g") != std::string::npos);
  REQUIRE(place.record("shock.csv --threshold 2.5") == 0); // 1 g at rest is less than half of it
  CHECK(place.screen().find("1 event beyond 2.5 g") != std::string::npos);
}

TEST_CASE("what a made record holds is found: two shocks, their peaks and durations") {
  const Place place;
  REQUIRE(place.record("--make endaq shock.csv") == 0);
  REQUIRE_MESSAGE(place.record("shock.csv --gravity z -o out") == 0, place.screen());
  CHECK(place.screen().find("2 events beyond 1 g") != std::string::npos);
  std::istringstream events(place.read("out/events.csv"));
  std::string line;
  std::getline(events, line);
  CHECK(line.starts_with("event,axis,segment,begin [s],end [s],peak time [s],peak [m/s^2]"));
  for (const auto& [at, peak] : {std::pair{3.025, 3.1}, std::pair{6.56, 1.6}}) {
    std::getline(events, line); // x, then y and z
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    REQUIRE(fields.size() > 9);
    CHECK(std::stod(fields[5]) == doctest::Approx(at).epsilon(0.003)); // the top of a half sine is flat, and there is noise of 0.01 g
    CHECK(std::stod(fields[6]) == doctest::Approx(peak * 9.80665).epsilon(0.01));
    std::getline(events, line);
    std::getline(events, line);
  }
}

TEST_CASE("the commands of docs/how-to/read_a_record.md do what it says, typed in their order") {
  const Place place;
  std::ifstream page(STEPLAP_SOURCE "/docs/how-to/read_a_record.md");
  int typed = 0, refused = 0;
  for (std::string line; std::getline(page, line);) {
    const std::string begin = "steplap record ";
    if (!line.starts_with(begin)) continue;
    const bool is_refused = line.ends_with("# refused");
    CAPTURE(line);
    const int code = place.record(line.substr(begin.size(), line.find(" #") - begin.size()));
    CHECK_MESSAGE(code == (is_refused ? 2 : 0), place.screen());
    ++typed;
    refused += is_refused;
  }
  CHECK(typed == 10);
  CHECK(refused == 1);
  CHECK(place.has("out/shock/signal.csv"));
  CHECK(place.read("out/first/event_1.csv").starts_with("time [s],x [m/s^2],"));
}
