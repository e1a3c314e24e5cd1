// steplap accuracy, and simulate --estimate-error.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

using namespace steplap::testing;

TEST_CASE("accuracy: table, CSV, diagram, one line of advice") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const std::vector<std::string> arguments{"accuracy",     model,    "-o",       bench.at("out"), "--integrator", "tsit5",
                                           "--integrator", "dop853", "--end",    "0.5",           "--repeats",    "1",
                                           "--error",      "1e-5",   "--budget", "5000"};
  const Outcome outcome = steplap_does(arguments);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  for (const char* part : {"reference: dop853 1e-13 and tsit5 1e-13", "Pareto", "positions ~ tolerance^", "… and 8 more in accuracy.csv"})
    CHECK_MESSAGE(has(outcome.out, part), part);
  std::istringstream lines(outcome.out);
  std::string answer;
  std::getline(lines, answer); // model and time
  std::getline(lines, answer);
  CHECK_MESSAGE(answer.starts_with("  cheapest for an error of 1e-05: "), answer);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) rows += line.starts_with("  tsit5 1e") || line.starts_with("  dop853 1e");
  CHECK(rows <= 12); // of 20
  CHECK(rows > 6);
  CHECK(bench.content("out/a") == std::set<std::string>{"accuracy.csv", "work_precision.svg"});
  const std::string csv = text_of(bench.at("out/a/accuracy.csv"));
  CHECK(csv.rfind("integrator,tolerance,step [s],cpu [s]", 0) == 0);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 22); // header, a comment, 2 × 10 tolerances
  CHECK(has(csv, "\n# the times,"));                     // what hangs on the clock says so
  CHECK(has(outcome.out, "budget: "));
  CHECK(has(outcome.out, " of 5000 s of CPU time"));
  const std::string svg = text_of(bench.at("out/a/work_precision.svg"));
  CHECK(svg.rfind("<svg", 0) == 0);
  CHECK(has(svg, "</svg>"));
  CHECK_FALSE(has(svg, "nan"));
  CHECK_FALSE(has(svg, "inf"));

  CHECK(steplap_does(arguments).code == 2); // stands there already
  auto forced = arguments;
  forced.push_back("--force");
  CHECK(steplap_does(forced).code == 0);
}

TEST_CASE("accuracy: what a budget has no room for is left out, and the table and the file say so") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  // A nanosecond has room for nothing, on any computer.
  const Outcome outcome = steplap_does(
      {"accuracy", model, "-o", bench.at("out"), "--integrator", "tsit5", "--integrator", "rk4", "--end", "0.2", "--budget", "1e-9"});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "left out as too dear (--budget gives more): "));
  for (const char* setting : {"tsit5 0.001", "tsit5 1e-12", "rk4 h = 0.008 s"}) CHECK_MESSAGE(has(outcome.out, setting), setting);
  const std::string csv = text_of(bench.at("out/a/accuracy.csv"));
  CHECK(has(csv, "the budget of 1e-09 s permitted depend on the computer"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 2 + 10 + 7);
  CHECK(has(csv, "left out: beyond the budget"));
  CHECK(steplap_does({"accuracy", model, "-o", bench.at("no"), "--budget", "0"}).code == 2);
}

TEST_CASE("accuracy: what is asked wrongly is one clear error") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator), out = bench.at("out");
  const auto refused = [&](std::vector<std::string> more, const char* message) {
    std::vector<std::string> arguments{"accuracy", model, "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = steplap_does(arguments);
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(has(outcome.err, message), outcome.err);
    CHECK_FALSE(fs::exists(out));
  };
  refused({"--integrator", "dop583"}, "unknown integrator 'dop583' (did you mean 'dop853'?)");
  refused({"--setting", "dop853"}, "should be INTEGRATOR@TOLERANCE");
  refused({"--setting", "dop853@fine"}, "should be a number above zero");
  refused({"--reference", "dop853@1e-9"}, "--reference is given twice");
  refused({"--error", "-1"}, "should be a number above zero");
  CHECK(steplap_does({"accuracy", bench.at("none.toml")}).code == 3);
  const Outcome slow = steplap_does({"accuracy", model, "-o", out, "--cpu-limit", "1e-9"});
  CHECK(slow.code == 4);
  CHECK(has(slow.err, "no reference: dop853 1e-13 failed"));
}

TEST_CASE("simulate --estimate-error tells the global error, on the screen and in the summary") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const Outcome adaptive =
      steplap_does({"simulate", "-v", model, "-o", bench.at("out"), "--estimate-error", "--integrator", "tsit5", "--tolerance", "1e-7"});
  CHECK(adaptive.code == 0);
  CHECK(has(adaptive.out, "estimated from a finer run (tsit5, tolerance 1e-09)"));
  CHECK(has(text_of(bench.at("out/a/summary.json")), "\"global_error\""));
  const Outcome fixed =
      steplap_does({"simulate", "-v", model, "-o", bench.at("fixed"), "--estimate-error", "--integrator", "rk4", "--step", "1e-3"});
  CHECK(has(fixed.out, "estimated from two adaptive runs (auto, tolerance 1e-09 and 1e-11)"));
  const Outcome stepped =
      steplap_does({"simulate", "-v", model, "-o", bench.at("stepped"), "--estimate-error", "--integrator", "moreau", "--step", "1e-3"});
  CHECK(has(stepped.out, "estimated from finer runs (moreau, step 5e-04 s and 0.00025 s)"));
  const Outcome plain = steplap_does({"simulate", "-v", model, "-o", bench.at("plain"), "--no-estimate"});
  CHECK_FALSE(has(plain.out, "Global error"));
  CHECK_FALSE(has(plain.out, "±"));
  CHECK(has(plain.out, "error not estimated: left out as asked"));
  CHECK_FALSE(has(text_of(bench.at("plain/a/summary.json")), "\"global_error\""));
  CHECK(steplap_does({"simulate", model, "-o", bench.at("x"), "--no-estimate", "--estimate-error"}).code == 2);
}

TEST_CASE("by default every number of a run stands with its error") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const Outcome outcome = steplap_does({"simulate", model, "-o", bench.at("out"), "--report"});
  CHECK(outcome.code == 0);
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) // events and extremes
    if (has(line, "floor  ") || has(line, "floor.force  ") || has(line, "energy dissipated")) CHECK_MESSAGE(has(line, " ± "), line);
  const std::string csv = text_of(bench.at("out/a/trajectory.csv"));
  CHECK(csv.rfind("t [s],ball.x [m]", 0) == 0); // names stay the first row
  CHECK(csv.find("\n# error estimate,") == csv.find('\n'));
  CHECK(text_of(bench.at("out/a/events.csv")).rfind("t [s],element,event,error of t [s]\n0.14", 0) == 0);
  const std::string summary = text_of(bench.at("out/a/summary.json"));
  for (const char* key : {"error_min", "error_t_max", "error_final", "error_dissipated", "\"errors\""})
    CHECK_MESSAGE(has(summary, key), key);
  CHECK(has(text_of(bench.at("out/a/report.html")), "\"text_max\":"));

  // Motion and events do not hang on it.
  CHECK(steplap_does({"simulate", model, "-o", bench.at("plain"), "--no-estimate"}).code == 0);
  std::string bare = csv;
  const std::size_t begin = bare.find('\n') + 1;
  bare.erase(begin, bare.find('\n', begin) + 1 - begin);
  CHECK(text_of(bench.at("plain/a/trajectory.csv")) == bare);
}

TEST_CASE("what is met within its error only is open, and says so") {
  const Workbench bench;
  // Dropped from 0.1 m it lands at v² = 2 g h; undamped the spring takes v √(k m) + m g and a little: 452.8 N or so. Then
  // the limit is the run's own value and half a millionth of it, where extremes are located to one: met, but not known to be.
  const std::string model = bench.write("a.toml", std::string(k_bouncer) + R"([[acceptance]]
name = "floor"
channel = "floor.force"
at_most = 1e4
)");
  const std::vector<std::string> run{"simulate", "-v", model, "--integrator", "dop853", "--tolerance", "1e-8", "--end", "0.3", "-o"};
  const auto with = [&](const std::string& folder, std::vector<std::string> more) {
    std::vector<std::string> arguments = run;
    arguments.push_back(bench.at(folder));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return steplap_does(arguments);
  };
  const Outcome far = with("far", {"--require-hold"});
  CHECK(far.code == 0);
  CHECK(has(far.out, "Verdict by the criteria of the model: hold"));
  const std::string summary = text_of(bench.at("far/a/summary.json"));
  const std::size_t entry = summary.find("\"floor.force\": {"), at = summary.find("\"max\": ", entry) + 7;
  const double largest = std::stod(summary.substr(at));
  CHECK(largest > 400.0);
  std::ostringstream limit;
  limit.precision(17);
  limit << "acceptance.floor.at_most=" << largest * (1.0 + 5e-7);
  const Outcome near = with("near", {"--require-hold", "--set", limit.str()});
  CHECK(near.code == 5);
  CHECK(has(near.out, "Verdict by the criteria of the model: open"));
  CHECK(has(near.out, "met, but the error reaches the limit"));
  CHECK(has(text_of(bench.at("near/a/summary.json")), "\"doubt\": \"met, but the error reaches the limit\""));
  // Without an estimate nothing is known of it: the verdict is the number's, and the screen says what it is worth.
  const Outcome plain = with("plain", {"--no-estimate", "--set", limit.str()});
  CHECK(has(plain.out, "Verdict by the criteria of the model: hold"));
  CHECK(has(plain.out, "judged without the errors of the numbers"));
}

TEST_CASE("an estimate of much work is left out by count, not by the clock, and it is said what it would take") {
  const Workbench bench;
  // A body and an element, one to four evaluations a step, six times as many steps for the estimate: 12 to 48 parts a step, less
  // than 1e7 for 50 000 steps, more for a million, however fast or slow the computer is.
  const std::string model = bench.write("a.toml", k_oscillator);
  const auto with = [&](const std::string& folder, const std::string& method, const std::string& end) {
    return steplap_does({"simulate", "-v", model, "-o", bench.at(folder), "--integrator", method, "--step", "1e-6", "--end", end});
  };
  CHECK(has(with("in", "moreau", "0.05").out, "estimated from finer runs (moreau, step 5e-07 s"));
  // References of fixed steps do not become dearer by shorter steps.
  CHECK(has(with("short", "rk4", "0.25").out, "estimated from two adaptive runs (auto, tolerance "));
  const Outcome slow = with("out", "moreau", "1");
  CHECK(slow.code == 0);
  CHECK(has(slow.out, "error not estimated: would take about "));
  CHECK(has(slow.out, "ask with --estimate-error"));
  CHECK(has(text_of(bench.at("out/a/summary.json")), "\"error_not_estimated\": \"the estimate would take long; ask for it explicitly\""));
}
