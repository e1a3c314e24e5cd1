// steplap accuracy, and simulate --estimate-error.
#include "tests/tools/workbench.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace steplap::testing;

TEST_CASE("accuracy: table, CSV, diagram, one line of advice") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const std::vector<std::string> arguments{"accuracy",     model,   "-o",           bench.at("out"),
                                           "--integrator", "tsit5", "--integrator", "dop853",
                                           "--end",        "0.5",   "--repeats",    "1",
                                           "--error",      "1e-5"};
  const Outcome outcome = steplap_does(arguments);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  for (const char* part : {"reference: dop853 1e-13 and tsit5 1e-13", "tsit5 1e-06", "dop853 1e-12",
                           "Pareto", "positions ~ tolerance^", "cheapest: for 1e-05 "})
    CHECK_MESSAGE(has(outcome.out, part), part);
  CHECK(bench.content("out/a") == std::set<std::string>{"accuracy.csv", "work_precision.svg"});
  const std::string csv = text_of(bench.at("out/a/accuracy.csv"));
  CHECK(csv.rfind("integrator,tolerance,step [s],cpu [s]", 0) == 0);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 21); // header, 2 × 10 tolerances
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
      steplap_does({"simulate", model, "-o", bench.at("out"), "--estimate-error", "--integrator",
                    "tsit5", "--tolerance", "1e-7"});
  CHECK(adaptive.code == 0);
  CHECK(has(adaptive.out, "estimated from a second run (tsit5, tolerance 1e-09)"));
  CHECK(has(text_of(bench.at("out/a/summary.json")), "\"global_error\""));
  const Outcome fixed = steplap_does(
      {"simulate", model, "-o", bench.at("fixed"), "--estimate-error", "--integrator", "rk4", "--step",
       "1e-3"});
  CHECK(has(fixed.out, "estimated from a second run (rk4, step 5e-04 s)"));
  const Outcome plain = steplap_does({"simulate", model, "-o", bench.at("plain")});
  CHECK_FALSE(has(plain.out, "Global error"));
  CHECK_FALSE(has(text_of(bench.at("plain/a/summary.json")), "global_error"));
}
