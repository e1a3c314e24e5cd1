// steplap show: what simulate said, from the folder; and what it says of folders that are none, or no longer whole.
#include "mbd/io/digest.h"
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <regex>

using namespace steplap::testing;

namespace {

// Without the lines that only the process that made a run can write, and the blanks of a column that they may have widened.
std::string tables_of(const std::string& screen) {
  std::istringstream stream(screen);
  std::string kept;
  for (std::string line; std::getline(stream, line);) {
    const bool is_of_making = line.starts_with("  CPU time ") || line.starts_with("Written to ") || line.starts_with("Results: ") ||
                              line.starts_with("  error not estimated: ");
    if (!is_of_making) kept += std::regex_replace(line, std::regex(" +"), " ") + "\n";
  }
  return kept;
}

// `simulate` says warnings in its log, `show` on the screen. Their further lines are indented by nine.
std::string without_warnings(const std::string& screen) {
  return std::regex_replace(screen, std::regex("(Warning: [^\n]*\n( {9}[^\n]*\n)*)|(… and [0-9]+ more warnings[^\n]*\n)"), "");
}

struct Screens {
  Outcome overview, tables; // of simulate
};

Screens simulated(const Workbench& bench, const std::vector<std::string>& models, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{"simulate", "-f", "-o", bench.at("out")};
  words.insert(words.end(), models.begin(), models.end());
  words.insert(words.end(), more.begin(), more.end());
  Screens screens{steplap_does(words), {}};
  words.emplace_back("-v");
  screens.tables = steplap_does(words);
  return screens;
}

void check_refused(const std::string& folder, const std::string& part) {
  CAPTURE(folder);
  for (const char* const how : {"-q", "-v"}) {
    const Outcome outcome = steplap_does({"show", how, folder});
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_MESSAGE(has(outcome.err, part), outcome.err);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1); // one error, no list of what follows from it
  }
}

} // namespace

TEST_CASE("show says of every machine and layout what simulate said, on one screen and in tables") {
  const Workbench bench;
  std::size_t count = 0;
  for (const char* const folder : {"paper", "layouts", "machines"})
    for (const auto& file : fs::directory_iterator(fs::path(STEPLAP_MODELS) / folder)) {
      if (file.path().extension() != ".toml") continue;
      ++count;
      const std::string run = bench.at("out/" + file.path().stem().string());
      CAPTURE(run);
      const Screens screens = simulated(bench, {file.path().string()});
      REQUIRE(screens.overview.code == 0);
      CHECK(without_warnings(steplap_does({"show", run}).out) == screens.overview.out);
      const Outcome tables = steplap_does({"show", "-v", run});
      CHECK(tables.code == 0);
      CHECK(tables_of(tables.out) == tables_of(screens.tables.out));
      CHECK_FALSE(has(tables.out, "CPU time"));
      CHECK(has(tables.out, "Results: " + run + "\n"));
    }
  CHECK(count >= 30);
  // A joint that bears nothing has an infinite margin. JSON has no infinity: it is not lost.
  const std::string idle = bench.write("idle.toml", "extends = \"" STEPLAP_MODELS "/benchmarks/hard/patch_rotation.toml\"\n"
                                                    "[[acceptance]]\nname = \"reserve\"\nchannel = \"joint.margin\"\nat_least = 1.5\n");
  const Screens screens = simulated(bench, {idle}, {"--set", "signal.ramp.peak=0"});
  const Outcome tables = steplap_does({"show", "-v", bench.at("out/idle")});
  CHECK(tables_of(tables.out) == tables_of(screens.tables.out));
  CHECK(has(tables.out, "∞ (limit 1.5)"));
}

TEST_CASE("show takes several runs as simulate takes several models, and runs of one model by their folders") {
  const Workbench bench;
  const std::vector<std::string> models{STEPLAP_MODELS "/paper/no_interference.toml", STEPLAP_MODELS "/paper/interference.toml"};
  const Screens screens = simulated(bench, models);
  const std::vector<std::string> folders{bench.at("out/no_interference"), bench.at("out/interference")};
  CHECK(steplap_does({"show", folders[0], folders[1]}).out == screens.overview.out);
  const Outcome tables = steplap_does({"show", "-v", folders[0], folders[1]});
  CHECK(tables_of(tables.out) == tables_of(screens.tables.out));
  CHECK(has(tables.out, "Side by side"));

  const std::string model = bench.write("a.toml", k_bouncer);
  CHECK(steplap_does({"simulate", model, "-o", bench.at("one")}).code == 0);
  CHECK(steplap_does({"simulate", model, "-o", bench.at("two"), "--set", "body.ball.mass=2"}).code == 0);
  const Outcome both = steplap_does({"show", "-v", bench.at("one/a"), bench.at("two/a")});
  CHECK(both.code == 0);
  const std::string side_by_side = both.out.substr(both.out.find("Side by side"));
  CHECK(has(side_by_side, bench.at("one/a")));
  CHECK(has(side_by_side, bench.at("two/a")));
}

TEST_CASE("show tells names of any characters, and numbers without errors, as simulate does") {
  const Workbench bench;
  std::string text = k_bouncer;
  text.replace(text.find("\"floor\""), 7, "'Böden, \"links\"'");
  const std::string model = bench.write("odd.toml", text);
  for (const char* const how : {"--estimate-error", "--no-estimate"}) {
    const Screens screens = simulated(bench, {model}, {how});
    CHECK_MESSAGE(screens.overview.code == 0, screens.overview.err);
    CHECK(steplap_does({"show", bench.at("out/odd")}).out == screens.overview.out);
    CHECK(tables_of(steplap_does({"show", "-v", bench.at("out/odd")}).out) == tables_of(screens.tables.out));
  }
}

TEST_CASE("show tells of a run that broke off that it did") {
  const Workbench bench;
  const Screens screens = simulated(bench, {bench.write("bad.toml", k_bouncer)}, {"--set", "simulation.max_events=2"});
  REQUIRE(screens.overview.code == 4);
  const Outcome overview = steplap_does({"show", bench.at("out/bad")}), tables = steplap_does({"show", "-v", bench.at("out/bad")});
  CHECK(overview.out == screens.overview.out);
  CHECK(has(overview.out, "The run stopped at "));
  CHECK(tables_of(tables.out) == tables_of(screens.tables.out));
  CHECK(has(tables.out, "STOPPED before the end: "));
}

TEST_CASE("show refuses a folder whose files are missing or not as they were written") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  for (const char* const name : {"trajectory.csv", "events.csv", "model.toml", "drawing.json", "summary.json"}) {
    CAPTURE(name);
    REQUIRE(steplap_does({"simulate", model, "-f", "-o", bench.at("out")}).code == 0);
    REQUIRE(steplap_does({"show", "-q", bench.at("out/a")}).code == 0);
    const std::string path = bench.at(std::string("out/a/") + name), whole = text_of(path);
    std::string other = whole;
    other[whole.size() / 2] = static_cast<char>(other[whole.size() / 2] ^ 1); // one bit
    bench.write(std::string("out/a/") + name, other);
    check_refused(bench.at("out/a"), "is not as steplap wrote it");
    bench.write(std::string("out/a/") + name, whole.substr(0, whole.size() - 1));
    check_refused(bench.at("out/a"), "is not as steplap wrote it");
    fs::remove(path);
    check_refused(bench.at("out/a"), std::string(name) == "summary.json" ? "no summary.json" : "is missing");
  }
}

TEST_CASE("show says what a folder is that is none of a run") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  REQUIRE(steplap_does({"simulate", model, "-o", bench.at("out")}).code == 0);
  check_refused(bench.at("nothing"), "is not a folder");
  check_refused(bench.at("out"), "holds folders of runs: name one of them, as '" + bench.at("out/a") + "'");
  check_refused(bench.at("out/a/summary.json"), "name the folder of the run, '" + bench.at("out/a") + "'");
  bench.write("record/record.json", "{}");
  check_refused(bench.at("record"), "is the folder of a record");
  bench.write("study.sqlite", "SQLite format 3\n");
  check_refused(bench.at("study.sqlite"), "is the file of a study");
  bench.write("empty/readme.txt", "");
  check_refused(bench.at("empty"), "holds no results");
}

TEST_CASE("show says so of a folder that another version wrote, whose summary lacks what it shows") {
  const Workbench bench;
  REQUIRE(steplap_does({"simulate", bench.write("a.toml", k_bouncer), "-o", bench.at("out")}).code == 0);
  std::string text = text_of(bench.at("out/a/summary.json"));
  text.replace(text.find("\"error_estimate\""), 16, "\"error_forgotten\"");
  const std::size_t tail = text.rfind(",\n  \"checksum\": \"");
  text = text.substr(0, tail) + ",\n  \"checksum\": \"" + steplap::sha256(text.substr(0, tail)) + "\"\n}\n";
  bench.write("out/a/summary.json", text);
  check_refused(bench.at("out/a"), "was written by another version of steplap");
}
