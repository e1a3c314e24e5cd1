// Scenes that are at rest, or hold, and that a run, its estimate or its second opinion once called unknown or not to be trusted.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

std::string rest(const std::string& name) { return std::string(STEPLAP_TEST_DATA) + "/rest/" + name + ".toml"; }

Outcome simulated(const Workbench& bench, const std::string& name, std::vector<std::string> more) {
  std::vector<std::string> arguments{"simulate", rest(name), "-o", bench.at("out"), "--force"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return steplap_does(arguments);
}

} // namespace

// The angle of friction is atan 0.5 = 26.565°, and the contacts bear both feet up to 60° and more.
TEST_CASE("a box below the angle of friction holds, at every angle and for any time") {
  const Workbench bench;
  for (const char* angle : {"5 deg", "12 deg", "20 deg", "24 deg", "26 deg"})
    for (const char* end : {"2", "10", "30", "60"}) {
      CAPTURE(std::string(angle));
      CAPTURE(std::string(end));
      const Outcome outcome =
          simulated(bench, "c02b_require_hold",
                    {"--require-hold", "--set", "parameters.slope=" + std::string(angle), "--set", "simulation.end=" + std::string(end)});
      CHECK(outcome.code == 0);
      CHECK_MESSAGE(outcome.out.rfind("HOLD", 0) == 0, outcome.out);
    }
  // Beyond it there is no rest to begin from, and what begins without is not held.
  const Outcome beyond = simulated(bench, "c02b_require_hold", {"--require-hold", "--set", "parameters.slope=27 deg", "--end", "2"});
  CHECK(beyond.code == 4);
  CHECK(has(beyond.err, "no static equilibrium"));
}

// μ m g = 49.05 N hold 48.85 N, on feet of any stiffness; 49.1 N they do not.
TEST_CASE("a block that holds by half a percent on stiff feet holds by both methods") {
  const Workbench bench;
  for (const char* stiffness : {"1e7", "1e8", "1e9"}) {
    CAPTURE(std::string(stiffness));
    const std::string set = "element.foot 0.stiffness=" + std::string(stiffness),
                      other = "element.foot 1.stiffness=" + std::string(stiffness);
    const Outcome outcome = simulated(bench, "c38_share", {"--require-hold", "--set", set, "--set", other});
    CHECK(outcome.code == 0);
    CHECK_MESSAGE(outcome.out.rfind("HOLD", 0) == 0, outcome.out);
    CHECK(simulated(bench, "c38_share", {"--require-hold", "--set", set, "--set", other, "--set", "signal.pulse.peak=4.92 m/s2"}).code ==
          5);
  }
}

TEST_CASE("what does not move is known, though no finer tolerance makes shorter steps") {
  const Workbench bench;
  const Outcome outcome = simulated(bench, "c48_open_at_rest", {});
  CHECK_MESSAGE(outcome.out.rfind("HOLD", 0) == 0, outcome.out);
  CHECK_FALSE(has(outcome.out, "not known"));
  CHECK(simulated(bench, "c48_open_at_rest", {"--require-hold"}).code == 0);
}

TEST_CASE("a range that is rounding is no motion that an error is measured by") {
  const Workbench bench;
  for (const auto& [name, set] :
       {std::pair{"record_ends_high", "simulation.end=1.0"}, {"hav", "signal.push.duration=500"}, {"box", "signal.push.peak=1"}}) {
    CAPTURE(std::string(name));
    const Outcome outcome = simulated(bench, name, {"--require-hold", "--set", set});
    CHECK_FALSE(has(outcome.out, "not to be trusted"));
    CHECK(outcome.code != 4);
  }
  // 1600 N of capacity bear 981 N and 1052 N across: a margin of 1600/1438.
  const Outcome sheets = simulated(bench, "record_ends_high", {"--set", "signal.a.after=hold"}); // without it, what came after is missing
  CHECK_MESSAGE(sheets.out.rfind("HOLD", 0) == 0, sheets.out);
  CHECK(has(sheets.out, "margin 1.11"));
  CHECK(simulated(bench, "box", {"--set", "signal.push.peak=1"}).out.rfind("HOLD", 0) == 0);
}

TEST_CASE("the inertia of a body that drives move acts on nothing, whatever it is; let go of, it does") {
  const Workbench bench;
  const Outcome driven = simulated(bench, "generator_driven", {});
  CHECK_FALSE(has(driven.err + driven.out, "does not fit its outline"));
  CHECK_FALSE(has(driven.out, "cannot mean"));
  const auto without = [&](const std::string& first, const std::string& behind) {
    const std::string drive = "[[element]]\nkind = \"prescribed_motion\"\nname = \"";
    std::string text = text_of(rest("generator_driven"));
    text.erase(text.find(drive + first), text.find(drive + behind) - text.find(drive + first));
    return steplap_does({"simulate", bench.write("free.toml", text), "-o", bench.at("out"), "--force", "--end", "0.1"});
  };
  // The inertia acts on nothing but rolling: without that drive the ship rolls by itself. Without the one that heaves it, it does not.
  const Outcome rolls = without("rolling", "heaving"), heaves = without("heaving", "no sway");
  CHECK(has(rolls.err + rolls.out, "does not fit its outline"));
  CHECK_FALSE(has(heaves.err + heaves.out, "does not fit its outline"));
  // A limit on what the drive bears is a criterion that the inertia acts on.
  const std::string limited = text_of(rest("generator_driven")) +
                              "[[acceptance]]\nname = \"drive\"\nchannel = \"rolling.reaction\"\nwithin = 1e12\nconsequence = \"reject\"\n";
  const Outcome borne = steplap_does({"simulate", bench.write("limited.toml", limited), "-o", bench.at("out"), "--force", "--end", "0.1"});
  CHECK(has(borne.err + borne.out, "does not fit its outline"));
}
