// The library behind the command line, as other tools use it.
#include "mbd/run/prominence.h"
#include "mbd/run/result_files.h"
#include "tests/tools/steplap/workbench.h"
#include "tools/steplap/command.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

using namespace steplap;
using namespace steplap::testing;

TEST_CASE("summary: extremes, slides and events of the paper's run") {
  RunOptions options;
  options.estimating = Estimating::never;
  const Report summary = judged_run(load_model(STEPLAP_MODELS "/paper/no_interference.toml"), options);
  CHECK_FALSE(summary.run.failure);
  REQUIRE(summary.find("bottom arresting.force"));
  // Extremes of the same run sampled every microsecond.
  CHECK(summary.find("bottom arresting.force")->low.value == doctest::Approx(-193529.2594).epsilon(1e-7));
  CHECK(summary.find("tank bottom.friction")->high.value == doctest::Approx(259957.8428).epsilon(1e-7));
  CHECK(summary.find("tank bottom.slide")->largest().value == doctest::Approx(0.791365887e-3).epsilon(1e-6));
  CHECK(summary.find("active part.theta")->low.value == doctest::Approx(-1.54498655e-3).epsilon(1e-6));
  CHECK(summary.find("nothing") == nullptr);
  CHECK(summary.event_counts.at("slips forward") == 1);
  CHECK(summary.event_counts.at("slips backward") == 2);
  CHECK(summary.event_counts.at("opens") == 4); // rear block, rear foot, front foot twice
  CHECK(summary.relative_energy_residual < 1e-8);
  CHECK(is_reaction(*summary.find("rear foot.force")->channel));
  CHECK_FALSE(is_reaction(*summary.find("tank bottom.capacity")->channel));
  CHECK_FALSE(is_reaction(*summary.find("rear foot.gap")->channel));
  CHECK(is_slide(*summary.find("tank bottom.slide")->channel));
}

TEST_CASE("names in CSV headers are quoted where they must be") {
  const Workbench bench;
  std::string text = k_oscillator;
  text.replace(text.find("\"spring\""), 8, "'front, \"left\"'");
  const Run run = run_model(load_model(bench.write("a.toml", text)));
  CHECK(has(trajectory_csv(*run.result.trajectory), ",\"front, \"\"left\"\".force [N]\""));
  CHECK(events_csv({{0.25, "a,b", EventKind::opens}}) == "t [s],element,event\n0.25,\"a,b\",opens\n");
}

// Processes in two containers on one share may have the same number. A lock tells which of them still writes.
TEST_CASE("folders of other processes that write are left, those of killed ones removed") {
  const Workbench bench;
  const std::string running = bench.at(".steplap-" + std::to_string(getpid())), killed = bench.at(".steplap-killed"),
                    starting = bench.at(".steplap-starting");
  for (const std::string& folder : {running, killed, starting}) {
    fs::create_directory(folder);
    std::ofstream(folder + "/trajectory.csv") << "t [s]\n";
  }
  for (const std::string& folder : {running, killed}) fs::last_write_time(folder, fs::file_time_type::clock::now() - std::chrono::hours(1));
  const int lock = open(running.c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(flock(lock, LOCK_EX | LOCK_NB) == 0);
  write_results(bench.at("run"), {{"summary.json", "1"}}, false);
  close(lock);
  CHECK(fs::exists(running + "/trajectory.csv"));
  CHECK(fs::exists(starting + "/trajectory.csv")); // made just now: its owner may not have locked it yet
  CHECK_FALSE(fs::exists(killed));
  CHECK(text_of(bench.at("run") + "/summary.json") == "1");
}

TEST_CASE("results are written as a whole or not at all") {
  const Workbench bench;
  const std::string folder = bench.at("deep/er/run");
  write_results(folder, {{"summary.json", "1"}, {"events.csv", "2"}}, false);
  CHECK(bench.content("deep/er") == std::set<std::string>{"run", "run/summary.json", "run/events.csv"});
  CHECK_THROWS_AS(write_results(folder, {{"summary.json", "3"}}, false), ResultsInTheWay);
  CHECK(text_of(folder + "/summary.json") == "1");
  write_results(folder, {{"partial_summary.json", "4"}}, true);
  CHECK(bench.content("deep/er") == std::set<std::string>{"run", "run/partial_summary.json"});
}
