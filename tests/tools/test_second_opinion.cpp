// steplap simulate --require-hold: a second method is asked before a verdict may hold.
#include "tests/tools/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

// Of lines to and fro between plus and minus 44 N, 2.5 ms each.
std::string wave() {
  std::string text = "t,F\n";
  for (int i = 0; i <= 160; ++i) text += std::to_string(2.5e-3 * i) + (i == 0 || i == 160 ? ",0\n" : i % 2 == 0 ? ",44\n" : ",-44\n");
  return text;
}

// A force on friction that holds 40 N. Beside it something moves, so that errors have a range.
std::string shaken_block(const std::string& shake) {
  return "[simulation]\nend = 0.4\nstep = 0.02\n[output]\nstep = 0.01\n"
         "[[body]]\nname = \"block\"\nmass = 10.0\ninertia = 1.0\n[[body]]\nname = \"walker\"\nmass = 1.0\ninertia = 1.0\nvelocity = [1.0, 0.0]\n"
         "[[element]]\nkind = \"prismatic\"\nname = \"path\"\na = \"walker\"\n[[element]]\nkind = \"prismatic\"\nname = \"road\"\na = \"block\"\n"
         "[[element]]\nkind = \"joint_friction\"\nname = \"grip\"\na = \"block\"\ncoordinate = \"x\"\nholds = 40.0\ndrags = 10.0\n"
         "[[signal]]\nname = \"shake\"\n" + shake +
         "[[element]]\nkind = \"load\"\nname = \"shaker\"\nat = \"block\"\nforce_x = \"shake\"\n"
         "[[acceptance]]\nname = \"grips\"\nevent = \"slips*\"\nconsequence = \"reject\"\n";
}
const std::string k_below = "kind = \"harmonics\"\namplitudes = [30.0]\nfrequencies = [200.0]\nphases = [\"-90 deg\"]\n";

} // namespace

TEST_CASE("a method that is blind in all its runs is contradicted by another one") {
  Workbench bench;
  // Time stepping takes the means of a force, from one corner of the record to the next, and in finer runs of halves and quarters of
  // that: 33 N at most. In truth it slides in every period.
  bench.write("wave.csv", wave());
  const std::string model = bench.write("shaken.toml", shaken_block("kind = \"record\"\nfile = \"wave.csv\"\n"));
  const std::vector<std::string> blind = {"simulate", model, "-o", bench.at("out"), "--force", "--integrator", "moreau"};
  CHECK(has(steplap_does(blind).out, "HOLD  "));
  std::vector<std::string> strict = blind;
  strict.push_back("--require-hold");
  const Outcome outcome = steplap_does(strict);
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "not to be trusted: a second method disagrees beyond both errors: dop853"));
  const std::string summary = text_of(bench.at("out/shaken/summary.json"));
  CHECK(has(summary, "\"agrees\": false"));
  CHECK(has(summary, "\"verdict\": \"open\""));
  strict[6] = "auto"; // which sees that it slips
  CHECK(steplap_does(strict).code == 5);
}

TEST_CASE("what holds by all methods holds, and it is said who was asked") {
  Workbench bench;
  const std::string model = bench.write("shaken.toml", shaken_block(k_below));
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4", "moreau"}) {
    CAPTURE(std::string(method));
    std::vector<std::string> command = {"simulate", model, "-o", bench.at("out"), "--force", "--integrator", method, "--require-hold"};
    if (method == std::string("rk4")) command.insert(command.end(), {"--step", "1e-4"});
    const Outcome outcome = steplap_does(command);
    CHECK(outcome.code == 0);
    CHECK(has(text_of(bench.at("out/shaken/summary.json")), method == std::string("moreau") ? "A second method, dop853, agrees." : "A second method, moreau, agrees."));
    CHECK(has(text_of(bench.at("out/shaken/summary.json")), "\"agrees\": true"));
  }
}

TEST_CASE("without --require-hold nobody else is asked") {
  Workbench bench;
  const Outcome outcome = steplap_does({"simulate", bench.write("shaken.toml", shaken_block(k_below)), "-o", bench.at("out")});
  CHECK_FALSE(has(outcome.out, "Second opinion"));
  CHECK_FALSE(has(text_of(bench.at("out/shaken/summary.json")), "second_opinion"));
}
