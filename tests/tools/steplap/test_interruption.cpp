// A run that is stopped from outside keeps what it has, and ends as the signal says; sizes that no machine holds are refused.
#include "mbd/rest/settling.h"
#include "mbd/run/run.h"
#include "tests/tools/steplap/workbench.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

using namespace steplap;
using namespace steplap::testing;

namespace {

struct Ended {
  int signal = 0; ///< 0: it ended by itself
  int code = 0;
};

// Runs the program and signals it after the delays, in seconds.
Ended run_and_signal(const std::vector<std::string>& arguments, const std::vector<std::pair<double, int>>& signals) {
  std::vector<char*> argv{const_cast<char*>(STEPLAP_PROGRAM)};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {1, 2}) posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", 1, 0);
  pid_t child = 0;
  REQUIRE(posix_spawn(&child, STEPLAP_PROGRAM, &actions, nullptr, argv.data(), environ) == 0);
  posix_spawn_file_actions_destroy(&actions);
  for (const auto& [delay, signal] : signals) {
    std::this_thread::sleep_for(std::chrono::duration<double>(delay));
    kill(child, signal);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? Ended{WTERMSIG(status), 0} : Ended{0, WEXITSTATUS(status)};
}

} // namespace

TEST_CASE("a run stopped by a signal keeps what was computed") {
  const Workbench bench;
  const std::string model = bench.write("long.toml", k_oscillator);
  // Days of steps, a row every few thousand of them. A machine may be so slow that the program is not yet listening when the
  // signal comes: then it dies of it, with nothing to keep, and is given longer.
  const std::vector<std::string> arguments = {"simulate", model,           "-o", bench.at("out"), "--force", "--set", "simulation.end=1e6",
                                              "--set",    "output.step=10"};
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    CAPTURE(signal);
    bool is_kept = false;
    for (double delay = 0.2; delay < 20.0 && !is_kept; delay *= 2.0) {
      const Ended ended = run_and_signal(arguments, {{delay, signal}});
      CHECK(ended.signal == signal);
      is_kept = fs::exists(bench.at("out") + "/long/partial_trajectory.csv");
    }
    CHECK(is_kept);
    CHECK(has(text_of(bench.at("out") + "/long/partial_summary.json"), "stopped by SIG"));
    CHECK_FALSE(fs::exists(bench.at("out") + "/long/trajectory.csv"));
    fs::remove_all(bench.at("out"));
  }
}

TEST_CASE("a time limit ends a run as a signal does, and keeps what was computed") {
  const Workbench bench;
  const std::string model = bench.write("long.toml", k_oscillator);
  const std::vector<std::string> long_run = {"simulate", model,           "-o", bench.at("out"), "--set", "simulation.end=1e6",
                                             "--set",    "output.step=10"};
  std::vector<std::string> limited = long_run;
  limited.insert(limited.end(), {"--time-limit", "0.3"});
  const Outcome outcome = steplap_does(limited);
  CHECK(outcome.code == 4);
  CHECK(has(outcome.err, "stopped by the time limit of 0.3 s at t = "));
  CHECK(fs::exists(bench.at("out") + "/long/partial_trajectory.csv"));
  std::vector<std::string> late = long_run;
  late.insert(late.end(), {"--force", "--time-limit", "1 ns"}); // over before the run begins
  const Outcome none = steplap_does(late);
  CHECK(none.code == 4);
  CHECK(has(none.err, "is not run: stopped by the time limit of 1e-09 s"));
  for (const char* const wrong : {"0", "-1 s", "nan", "soon", "3 kg"}) {
    std::vector<std::string> refused = long_run;
    refused.insert(refused.end(), {"--time-limit", wrong});
    CHECK(steplap_does(refused).code == 2);
  }
}

// A program that has started holds more than a megabyte.
TEST_CASE("a memory limit ends a run as a time limit does") {
  const Workbench bench;
  const std::string model = bench.write("long.toml", k_oscillator);
  const std::vector<std::string> run = {"simulate", model, "-o", bench.at("out")};
  const auto limited_to = [&](const std::string& limit) {
    std::vector<std::string> arguments = run;
    arguments.insert(arguments.end(), {"--force", "--memory-limit", limit});
    return steplap_does(arguments);
  };
  const Outcome over = limited_to("1 MB");
  CHECK(over.code == 4);
  CHECK(has(over.err, "is not run: stopped by the memory limit of 1 MB"));
  CHECK(limited_to("100GB").code == 0);
  for (const char* const wrong : {"0 GB", "-1 GB", "nan GB", "2", "2 m", "much"}) CHECK(limited_to(wrong).code == 2);
}

// Both searches ask before each of their steps, so a question that is answered at once ends them before they move anything.
TEST_CASE("the search for rest stops when asked") {
  const Workbench bench;
  const auto loaded = load_model(bench.write("falls.toml", k_bouncer), {"simulation.initial=equilibrium"});
  RunOptions options;
  int asked = 0;
  options.stop = [&asked] { return ++asked > 1 ? std::string("stopped by the test") : std::string(); };
  CHECK_THROWS_WITH_AS((void)run_model(loaded, options), doctest::Contains("stopped by the test in the search for rest"), RunStopped);
  const State start = loaded->assembled;
  const StopQuestion now = [] { return std::string("stopped by the test"); };
  const StopScope scope(now);
  CHECK_THROWS_AS((void)settle_in_time(*loaded->system, start), RunStopped);
}

TEST_CASE("a trajectory beyond the limit is refused before the run, and its size told") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator);
  for (const char* command : {"check", "simulate"}) {
    const Outcome outcome = steplap_does({command, model, "--set", "output.step=1e-12"});
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, "e+12 numbers"));
    CHECK(has(outcome.err, "raise 'most_numbers' of [output]"));
  }
  CHECK(steplap_does({"check", model, "--set", "output.step=1e-12", "--set", "output.most_numbers=1e14"}).code == 0);
  CHECK(has(steplap_does({"check", model}).out, "every 0.01 s, 11 rows"));

  // A row at each multiple of the step and one at the end of 0.1 s, as simulate writes them.
  for (const auto& [step, rows] : {std::pair("0.03", 5), std::pair("0.05", 3), std::pair("0.1", 2), std::pair("0.06", 3)}) {
    CAPTURE(step);
    const std::string set = "output.step=" + std::string(step);
    CHECK(has(steplap_does({"check", model, "--set", set}).out, "every " + std::string(step) + " s, " + std::to_string(rows) + " rows"));
    const auto loaded = load_model(model, {set});
    CHECK(run_model(loaded).result.trajectory->size() == static_cast<std::size_t>(rows));
  }
}

// The parser bounds brackets by 256; a key of many parts makes as many tables within each other.
TEST_CASE("keys of thousands of parts are refused, points in quotes are no parts") {
  const Workbench bench;
  std::string key = "x";
  for (int i = 0; i < 30000; ++i) key += ".x";
  for (const std::string& line : {key + " = 1\n", "[" + key + "]\na = 1\n"}) {
    const Outcome outcome = steplap_does({"check", bench.write("deep.toml", line)});
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, "a key of more than 256 parts"));
  }
  const std::string points(1000, '.');
  for (const std::string& quoted :
       {"\"" + points + "\\\"" + points + "\"", "'" + points + "'", "\"\"\"\n" + points + "\"\n\"\"\"", "'''" + points + "\n'''"}) {
    const Outcome outcome = steplap_does({"check", bench.write("b.toml", "source = " + quoted + " # " + points + "\n" + k_oscillator)});
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
  }
}

TEST_CASE("a working folder that is gone is an error of use, not a fault of the program") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator);
  const fs::path before = fs::current_path();
  fs::create_directory(bench.at("gone"));
  fs::current_path(bench.at("gone"));
  fs::remove(bench.at("gone"));
  const Outcome outcome = steplap_does({"simulate", model, "-o", "out"});
  fs::current_path(before);
  CHECK(outcome.code == 2);
  CHECK(has(outcome.err, "cannot use 'out/a': No such file or directory"));
}
