// Problems that have no solution, or none in a lifetime: a clear stop, with what there is saved,
// never a hang.
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/accuracy_study.h"
#include "tests/tools/steplap/workbench.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A mass on a spring, and whatever a case adds.
std::string scene(const std::string& more, const std::string& simulation = "step = 1e-3") {
  return "[simulation]\n" + simulation + R"(
end = 1.0
[output]
step = 0.1
[[body]]
name = "mass"
mass = 1.0
inertia = 1.0
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
stiffness = 100.0
[[signal]]
name = "up"
kind = "constant"
value = 1.0
[[signal]]
name = "down"
kind = "constant"
value = -1.0
)" + more;
}

Outcome simulated(const Workbench& bench, const std::string& text) {
  return steplap_does({"simulate", bench.write("a.toml", text), "-o", bench.at("out")});
}

void is_refused(const std::string& text, const char* message) {
  const Workbench bench;
  const Outcome outcome = simulated(bench, text);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 3);
  CHECK(has(outcome.err, "a.toml:"));
  CHECK(has(outcome.err, message));
  CHECK_FALSE(fs::exists(bench.at("out")));
}

void is_given_up(const std::string& text, const char* message) {
  const Workbench bench;
  const Outcome outcome = simulated(bench, text);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 4);
  CHECK(has(outcome.err, message));
}

} // namespace

// Their squares are infinite, and what is no number passes every comparison with a tolerance.
TEST_CASE("joints and ropes at distances beyond all numbers are refused") {
  std::ostringstream text;
  text << std::ifstream(STEPLAP_TEST_DATA "/peers/iftomm_four_bar.toml").rdbuf();
  std::string four_bar = text.str();
  const std::string last = "b = { body = \"ground\", point = [1,0] }";
  REQUIRE(has(four_bar, last));
  four_bar.replace(four_bar.find(last), last.size(), "b = { body = \"ground\", point = [1e300,0] }");
  is_refused(four_bar, "cannot be assembled: distances are beyond what numbers hold");
  is_refused(scene("[[element]]\nkind = \"rope\"\nname = \"rope\"\na = \"mass\"\nb = { body = \"ground\", at = [-1e300, 0.0] "
                   "}\ninextensible = true\n"),
             "distances are beyond what numbers hold");
}

TEST_CASE("an initial pose that cannot be assembled is the model's error") {
  is_refused(scene(R"(
[[element]]
kind = "distance"
name = "short rod"
a = "mass"
b = { body = "ground", at = [-5.0, 0.0] }
length = 1.0
[[element]]
kind = "distance"
name = "other rod"
a = "mass"
b = { body = "ground", at = [5.0, 0.0] }
length = 1.0
)"),
             "rod");
}

TEST_CASE("infinite and undefined numbers are refused where they stand") {
  is_refused(scene("[[element]]\nkind = \"spring_damper\"\nname = \"rigid\"\na = \"mass\"\naxis = "
                   "[0.0, 1.0]\nstiffness = inf\n"),
             "stiffness");
  is_refused(scene("[[element]]\nkind = \"spring_damper\"\nname = \"odd\"\na = \"mass\"\naxis = "
                   "[0.0, 1.0]\nstiffness = nan\n"),
             "stiffness");
}

TEST_CASE("a record with a value that is no number is refused with file and line") {
  const Workbench bench;
  bench.write("record.csv", "t,f\n0.0,1.0\n0.1,nan\n0.2,1.0\n");
  const Outcome outcome = simulated(bench, scene("[[signal]]\nname = \"r\"\nkind = \"record\"\nfile = \"record.csv\"\n[[element]]\nkind "
                                                 "= \"load\"\nname = \"push\"\nat = \"mass\"\nforce_x = \"r\"\n"));
  CAPTURE(outcome.err);
  CHECK(outcome.code == 3);
  CHECK(has(outcome.err, "record.csv:3"));
}

TEST_CASE("drives that contradict each other end the run") {
  const std::string drives = R"(
[[element]]
kind = "prescribed_motion"
name = "this way"
a = "mass"
signal = "up"
as = "velocity"
[[element]]
kind = "prescribed_motion"
name = "that way"
a = "mass"
signal = "down"
as = "velocity"
)";
  is_given_up(scene(drives), "way'");
}

TEST_CASE("a step of which it would take 1e12 is refused") { is_refused(scene("", "integrator = \"rk4\"\nstep = 1e-12"), "1e+12 steps"); }

// An adaptive method finds its steps while it runs: what they add up to is seen after a few.
TEST_CASE("a motion so fast that adaptive steps would never end is given up, with what there is saved") {
  const Workbench bench;
  const std::string text = scene("[[element]]\nkind = \"spring_damper\"\nname = \"glass\"\na = "
                                 "\"mass\"\naxis = [0.0, 1.0]\nstiffness = 1e27\n",
                                 "integrator = \"dop853\"\ntolerance = 1e-8");
  const Outcome outcome = simulated(bench, text);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 4);
  CHECK(has(outcome.err, "steps"));
  CHECK(has(text_of(bench.at("out/a/partial_summary.json")), "\"final_state\""));
}

TEST_CASE("friction that starts while it has to hold more than it can, on a foot that leaves, "
          "gives an answer") {
  // The foot is pressed by nothing and pushed sideways: no normal force, no friction, free fall
  // along x.
  const Workbench bench;
  const Outcome outcome = simulated(bench, scene(R"(
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "mass"
stiffness = 1e5
gap = 0.0
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = 0.0
)"));
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
}
