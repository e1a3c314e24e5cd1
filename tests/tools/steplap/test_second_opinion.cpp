// steplap simulate --require-hold: a second method is asked before a verdict may hold.
#include "tests/physics/model_text.h"
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

// Of lines to and fro between 100 and 60 N, 2.5 ms each.
std::string pressing() {
  std::string text = "t,N\n";
  for (int i = 0; i <= 160; ++i) text += std::to_string(2.5e-3 * i) + (i % 2 == 0 ? ",-100\n" : ",-60\n");
  return text;
}

// A block on two stiff feet, of friction 0.4 at rest, that is pulled by 24.1 N and pressed on by that record: it slides where the
// press is below 60.25 N. Beside it something moves, so that errors have a range.
const std::string k_pressed_block = R"(gravity = [0.0, 0.0]
[simulation]
end = 0.4
step = 0.02
initial = "equilibrium"
[output]
step = 0.01
[[body]]
name = "block"
mass = 10.0
inertia = 1.0
[[body]]
name = "walker"
mass = 1.0
inertia = 1.0
velocity = [1.0, 0.0]
[[element]]
kind = "prismatic"
name = "path"
a = "walker"
[[element]]
kind = "unilateral_contact"
name = "left foot"
a = { body = "block", at = [-1.0, 0.0] }
b = "ground"
normal = [0.0, 1.0]
stiffness = 1e9
damping = 1e6
[[element]]
kind = "unilateral_contact"
name = "right foot"
a = { body = "block", at = [1.0, 0.0] }
b = "ground"
normal = [0.0, 1.0]
stiffness = 1e9
damping = 1e6
[[element]]
kind = "coulomb_stick"
name = "grip"
contacts = ["left foot", "right foot"]
static_friction = 0.4
kinetic_friction = 0.1
[[signal]]
name = "press"
kind = "record"
file = "press.csv"
[[signal]]
name = "pull"
kind = "constant"
value = 24.1
[[element]]
kind = "load"
name = "presser"
at = "block"
force_y = "press"
force_x = "pull"
[[acceptance]]
name = "grips"
event = "slips*"
consequence = "reject"
)";

// A force on friction that holds 40 N. Beside it something moves, so that errors have a range.
std::string shaken_block(const std::string& shake) {
  return "[simulation]\nend = 0.4\nstep = 0.02\n[output]\nstep = 0.01\n"
         "[[body]]\nname = \"block\"\nmass = 10.0\ninertia = 1.0\n[[body]]\nname = \"walker\"\nmass = 1.0\ninertia = 1.0\nvelocity = [1.0, "
         "0.0]\n"
         "[[element]]\nkind = \"prismatic\"\nname = \"path\"\na = \"walker\"\n[[element]]\nkind = \"prismatic\"\nname = \"road\"\na = "
         "\"block\"\n"
         "[[element]]\nkind = \"joint_friction\"\nname = \"grip\"\na = \"block\"\ncoordinate = \"x\"\nholds = 40.0\ndrags = 10.0\n"
         "[[signal]]\nname = \"shake\"\n" +
         shake +
         "[[element]]\nkind = \"load\"\nname = \"shaker\"\nat = \"block\"\nforce_x = \"shake\"\n"
         "[[acceptance]]\nname = \"grips\"\nevent = \"slips*\"\nconsequence = \"reject\"\n";
}
const std::string k_below = "kind = \"harmonics\"\namplitudes = [30.0]\nfrequencies = [200.0]\nphases = [\"-90 deg\"]\n";

} // namespace

TEST_CASE("a method that is blind in all its runs is contradicted by another one") {
  Workbench bench;
  // Time stepping takes the mean of a force from one corner of the record to the next, and in its finer runs of halves, quarters and
  // eighths of that: 62.5 N at least, which hold 25 N. What a stiff foot presses by it sees at the ends of its steps alone.
  bench.write("press.csv", pressing());
  const std::string model = bench.write("pressed.toml", k_pressed_block);
  const std::vector<std::string> blind = {"simulate", model, "-o", bench.at("out"), "--force", "--integrator", "moreau"};
  CHECK(has(steplap_does(blind).out, "HOLD  "));
  std::vector<std::string> strict = blind;
  strict.push_back("--require-hold");
  const Outcome outcome = steplap_does(strict);
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "not to be trusted: a second method disagrees beyond both errors: moreau and dop853"));
  const std::string summary = text_of(bench.at("out/pressed/summary.json"));
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
    CHECK(has(text_of(bench.at("out/shaken/summary.json")),
              method == std::string("moreau") ? "A second method, dop853, agrees." : "A second method, moreau, agrees."));
    CHECK(has(text_of(bench.at("out/shaken/summary.json")), "\"agrees\": true"));
  }
}

// A load on a deck that brakes by 0.42 g, with friction 0.5. It stays at rest, and both runs of auto take the same steps, so their difference is
// zero: it does not show what a step tolerates there, 1e-9 m/s, by which time stepping differs.
TEST_CASE("a load that rests on a braking deck holds by both methods, although the estimate of one is zero") {
  Workbench bench;
  std::string scene = "simulation = { end = 1.56, initial = 'equilibrium' }\n" + body("deck", "mass = 5e4; inertia = 1e5") +
                      element("prismatic", "road", "a = 'deck'") +
                      signal_entry("haversine", "brake", "peak = -4.07962; start = 0.05; duration = 0.229") +
                      element("prescribed_motion", "drive", "a = 'deck'; signal = 'brake'") +
                      body("load", "mass = 106.5; inertia = 9.94355; position = [0, 0.2]");
  for (const std::string x : {"-0.49", "0.49"})
    scene += element("unilateral_contact", "foot at " + x,
                     "a = { body = 'load', point = [" + x + ", -0.2] }; b = 'deck'; stiffness = 2.79712e6; damping = 6671.36");
  scene += element("coulomb_stick", "friction",
                   "contacts = ['foot at -0.49', 'foot at 0.49']; static_friction = 0.5; kinetic_friction = 0.458") +
           table_text("acceptance", "name = 'slide'\n", "channel = 'friction.slide'; within = '5 mm'; consequence = 'reject'");
  const std::string model = bench.write("resting.toml", scene);
  const Outcome outcome = steplap_does({"simulate", model, "-o", bench.at("out"), "--require-hold"});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "HOLD  "));
}

TEST_CASE("without --require-hold nobody else is asked") {
  Workbench bench;
  const Outcome outcome = steplap_does({"simulate", bench.write("shaken.toml", shaken_block(k_below)), "-o", bench.at("out")});
  CHECK_FALSE(has(outcome.out, "Second opinion"));
  CHECK_FALSE(has(text_of(bench.at("out/shaken/summary.json")), "second_opinion"));
}

namespace {

// Beside it a strap that remembers whether it has broken, which time stepping does not follow.
std::string with_a_strap(const std::string& scene) {
  return scene + "[[element]]\nkind = \"tie\"\nname = \"strap\"\na = \"walker\"\nb = { body = \"ground\", at = [0.0, -1.0] }\n" +
         "stiffness = 1.0\ndamping = 0.1\nstrength = 1e6\n";
}

// A push of 60 N while the walker, with 1 m/s, passes over two millimetres: exp(−N φ²/2) with N = 16⁴, which is not searched within steps as
// exponentials and comparisons are (FormulaProgram::may_peak).
std::string pushed_briefly() {
  const std::string still = shaken_block("kind = \"constant\"\nvalue = 0.0\n");
  return with_a_strap(still + "[[element]]\nkind = \"force\"\nname = \"push\"\na = \"block\"\ncoordinate = \"x\"\nformula = \"'60 N' * "
                              "((((cos((walker.x - '0.1117 m') / '0.318 m')^16)^16)^16)^16)\"\n");
}

} // namespace

TEST_CASE("where time stepping cannot serve another method is asked, in steps drawn at random") {
  Workbench bench;
  const std::string model = bench.write("strapped.toml", with_a_strap(shaken_block(k_below)));
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Outcome outcome = steplap_does({"simulate", model, "-o", bench.at("out"), "--force", "--integrator", method, "--require-hold"});
    CHECK(outcome.code == 0);
    const std::string summary = text_of(bench.at("out/strapped/summary.json"));
    CHECK(has(summary, std::string("A second method, ") + (method == std::string("tsit5") ? "rodas5p" : "tsit5") +
                           " in steps drawn at random, agrees."));
    CHECK_FALSE(has(summary, "\"drawn_step\": null"));
  }
}

TEST_CASE("what passes between all looks of a run is met in steps drawn at random") {
  Workbench bench;
  const std::string model = bench.write("pushed.toml", pushed_briefly());
  const std::vector<std::string> blind = {"simulate",      model,          "-o",  bench.at("out"), "--force",
                                          "--no-estimate", "--integrator", "rk4", "--step",        "0.02"};
  CHECK(has(steplap_does(blind).out, "HOLD  "));
  std::vector<std::string> strict = blind;
  strict.push_back("--require-hold");
  const Outcome outcome = steplap_does(strict);
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "not to be trusted: a second method disagrees beyond both errors"));
}

TEST_CASE("a verdict whose numbers nothing has checked does not hold, and says so") {
  // A tie whose damper stops its body within a nanosecond: no explicit method gets on, and no other is left beside rodas5p.
  Workbench bench;
  const std::string model = bench.write("stiff.toml", R"(gravity = [0.0, 0.0]
[simulation]
end = 1.0
integrator = "rodas5p"
tolerance = 1e-6
[[body]]
name = "b"
mass = 0.01
inertia = 0.01
[[element]]
kind = "tie"
name = "strap"
a = { body = "b", at = [0.0, 0.0] }
b = { body = "ground", at = [0.0, 1.0] }
axis = [0.0, 1.0]
acts = "both"
stiffness = 1e9
damping = 1e8
strength = "20 kN"
[[signal]]
name = "push"
kind = "haversine"
peak = "100 N"
start = 0.1
duration = 0.3
[[element]]
kind = "load"
name = "pusher"
at = "b"
force_y = "push"
)");
  const std::vector<std::string> command = {"simulate", model, "-o", bench.at("out"), "--force", "--require-hold"};
  CHECK(steplap_does(command).code == 0); // its errors are estimated
  std::vector<std::string> unchecked = command;
  unchecked.push_back("--no-estimate");
  const Outcome outcome = steplap_does(unchecked);
  CHECK(outcome.code == 5);
  CHECK(has(outcome.out, "nothing has checked its numbers"));
}

// Two rods swing over their tops: neighbouring motions part tenfold in about 2 s, so that two methods of 1e-7 can be compared for some 20 s.
TEST_CASE("a second method that can be compared at the beginning only has not checked the end") {
  const Workbench bench;
  const std::string model = bench.write("swing.toml", R"(format = 1
simulation = { end = 50 }
output = { step = 0.1 }
[[body]]
name = "one"
mass = 1
inertia = 0.01
position = [1, 0]
[[body]]
name = "two"
mass = 1
inertia = 0.01
position = [2, 0.3]
[[element]]
kind = "revolute"
name = "first"
a = { body = "one", at = [0, 0] }
[[element]]
kind = "revolute"
name = "second"
a = { body = "two", at = [1, 0] }
b = { body = "one", at = [1, 0] }
[[acceptance]]
name = "turns"
channel = "two.theta"
within = "400 rad"
consequence = "reject"
)");
  std::vector<std::string> command = {"simulate", model, "-o", bench.at("out"), "--force", "--no-estimate", "--require-hold"};
  const Outcome whole = steplap_does(command);
  CHECK(whole.code == 5);
  CHECK(has(whole.out, "nothing has checked its numbers after"));
  CHECK(has(whole.out, "t = 2")); // s
  command.insert(command.end(), {"--end", "5"});
  CHECK(steplap_does(command).code == 0); // compared to the end
}
