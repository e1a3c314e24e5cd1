// steplap channels, lists of the channels of a kind, and channels on request in everything that a run writes.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A formula, energies and a marker on the oscillator: x = v₀/ω sin ωt, ω = 20/s, v₀ = 0.1 m/s.
std::string asking() {
  std::string text = k_oscillator;
  text.replace(text.find("step = 0.01"), 11, "step = 0.01\nalso = [\"edge.*\", \"whole.kinetic\", \"spring.stored\"]");
  return text + R"([[marker]]
name = "edge"
body = "mass"
point = [0.5, 0]
[[channel]]
name = "share of 10 N"
expression = "abs({spring.force [N]}) / '10 N'"
meaning = "how much of the wire's strength is used"
[[plot]]
name = "use"
channels = ["share of 10 N"]
[[acceptance]]
name = "strong enough"
channel = "share of 10 N"
at_most = 0.5
)";
}

} // namespace

TEST_CASE("steplap channels lists unit, sign, meaning and codes, made or on request") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", asking());
  const Outcome all = steplap_does({"channels", model});
  CHECK(all.code == 0);
  for (const char* part : {"mass.theta", "positive counter-clockwise", "edge.ax", "from the equations of motion", "share of 10 N",
                           "how much of the wire's strength is used", "on request", "whole.balance", "spring.dissipated"})
    CHECK_MESSAGE(has(all.out, part), part);
  const Outcome some = steplap_does({"channels", model, "--only", "spring.*", "-o", bench.at("list.csv")});
  CHECK(some.code == 0);
  CHECK(!has(some.out, "mass.x"));
  const std::string csv = text_of(bench.at("list.csv"));
  CHECK(csv.rfind("channel,unit,made,sign,meaning,codes\n", 0) == 0);
  CHECK(has(csv, "spring.stored,J,written,"));
  CHECK(has(csv, "spring.dissipated,J,on request,"));
  CHECK(steplap_does({"channels", model, "-o", bench.at("list.csv"), "-q"}).code == 2); // there already
  const Outcome wrong = steplap_does({"channels", model, "--only", "spring.forse"});
  CHECK(wrong.code == 2);
  CHECK(has(wrong.err, "did you mean 'spring.force'?"));
}

TEST_CASE("steplap elements lists the channels of a kind") {
  const Outcome friction = steplap_does({"elements", "coulomb_stick"});
  CHECK(has(friction.out, "NAME.mode"));
  CHECK(has(friction.out, "0 free, 1 sticks, 2 slips"));
  const Outcome motor = steplap_does({"elements", "motor"});
  for (const char* part :
       {"NAME.couple", "NAME.force", "NAME.angle", "NAME.displacement", "rad/s or m/s", "on request", "negative while it brakes"})
    CHECK_MESSAGE(has(motor.out, part), part);
  CHECK(has(steplap_does({"elements", "marker"}).out, "NAME.ay"));
  CHECK(has(steplap_does({"elements", "output"}).out, "whole.balance"));
}

TEST_CASE("channels on request are in the trajectory, the summary with errors, the judgement, the plots and the page") {
  const Workbench bench;
  const Outcome run =
      steplap_does({"simulate", "-v", bench.write("a.toml", asking()), "-o", bench.at("out"), "--estimate-error", "--report"});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  CHECK(has(run.out, "Channels on request"));
  CHECK(has(run.out, "share of 10 N"));
  const std::string trajectory = text_of(bench.at("out/a/trajectory.csv"));
  const std::string head = trajectory.substr(0, trajectory.find('\n'));
  for (const char* part : {"edge.x [m]", "edge.ay [m/s^2]", "whole.kinetic [J]", "spring.stored [J]", "share of 10 N"})
    CHECK_MESSAGE(has(head, part), part);
  const auto summary = nlohmann::json::parse(text_of(bench.at("out/a/summary.json")));
  // ω v₀ m = 4 N within 0.1 s (2 rad): the top of |sin| is inside a step.
  const auto& share = summary["extremes"]["share of 10 N"];
  CHECK(share["max"].get<double>() == doctest::Approx(0.4).epsilon(2e-6));
  CHECK(share["error_max"].get<double>() < 1e-5);
  CHECK(share["t_max"].get<double>() == doctest::Approx(std::acos(-1.0) / 40.0).epsilon(1e-3));
  CHECK(summary["meanings"][share["meaning"].get<std::size_t>()] == "how much of the wire's strength is used");
  CHECK(summary["extremes"]["spring.stored"]["max"].get<double>() == doctest::Approx(0.01).epsilon(2e-6)); // ½ m v₀²
  CHECK(summary["judgement"]["verdict"] == "hold");
  std::string page;
  for (const std::string& name : bench.content("out"))
    if (name.ends_with("report.html")) page = text_of(bench.at("out/" + name));
  CHECK(has(page, "how much of the wire's strength is used"));
  CHECK(has(page, "s.run.meaning(s.name)")); // the tooltip
  const Outcome plot = steplap_does({"plot", bench.at("out/a"), "--channels", "share of 10 M", "-o", bench.at("x.svg")});
  CHECK(plot.code == 2);
  CHECK(has(plot.err, "did you mean 'share of 10 N'?"));
}

TEST_CASE("a formula without a value is told, not passed over") {
  const Workbench bench;
  const std::string text = std::string(k_oscillator) + "[[channel]]\nname = \"it\"\nexpression = \"mass.vx / mass.x\"\n";
  const Outcome run = steplap_does({"simulate", bench.write("a.toml", text), "-o", bench.at("out")});
  CHECK(run.code == 0);
  CHECK(has(run.err, "channel 'it' had no value at some time"));
  CHECK(has(text_of(bench.at("out/a/summary.json")), "\"had_no_value\": true"));
  CHECK(has(text_of(bench.at("out/a/trajectory.csv")), "nan"));
}

TEST_CASE("names that no list could show are refused with their line") {
  const Workbench bench;
  for (const char* name : {"share [a]", "a{b}", "", "two\\nlines"}) {
    const std::string text = std::string(k_oscillator) + "[[channel]]\nname = \"" + name + "\"\nexpression = \"1\"\n";
    const Outcome check = steplap_does({"check", bench.write("a.toml", text)});
    CHECK_MESSAGE(check.code == 3, name);
    CHECK(has(check.err, "a.toml:2"));
  }
}
