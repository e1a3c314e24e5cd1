// Designs against closed forms: the value of a variable with which all limits hold, for certain or with a target reliability.
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"

#include <array>

using namespace steplap;
using namespace steplap::testing;

namespace {

// D = A t²/2 (A/(mu g) − 1) for A = 0.5 g, t = 0.2 s and D = 10 mm.
constexpr double k_least_friction = 0.45374653;

const std::string k_friction = "[[variable]]\nname = \"friction\"\npath = \"element.deck friction.static_friction\"\n";

// The block under that pulse, which may slide by 10 mm.
std::string limited_block() {
  std::string text = k_block;
  const auto replace = [&text](const std::string& before, const std::string& after) {
    text.replace(text.find(before), before.size(), after);
  };
  replace("peak = 5.886", "peak = 4.905");
  replace("duration = 0.1", "duration = 0.2");
  return text + "[[acceptance]]\nname = \"slide\"\nchannel = \"deck friction.slide\"\nwithin = \"10 mm\"\n";
}

std::string formula(const std::string& limit, const std::string& variable, const std::string& settings = "") {
  return "kind = \"design\"\n[design]\n" + settings + "[[variable]]\nname = \"x\"\n" + variable +
         "\n[[limit_state]]\nname = \"limit\"\nexpression = \"" + limit + "\"\n";
}

// Values of "holds from" and "holds to", in order.
std::vector<double> ends_of(const StudyBench& bench) {
  std::vector<double> ends;
  for (const study::Finding& f : bench.findings())
    if (f.quantity.starts_with("holds ")) ends.push_back(f.value);
  return ends;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

} // namespace

TEST_CASE("the least friction with which a block slides no further than 10 mm") {
  StudyBench bench;
  bench.write("block.toml", limited_block());
  const Outcome outcome = bench.run("model = \"block.toml\"\nkind = \"design\"\n[design]\npoints = 5\ntolerance = 1e-7\n" + k_friction +
                                    "range = [0.4, 0.6]\n");
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  const study::Finding from = bench.find("design", "holds from");
  // On the safe side, by the tolerance and the estimated error of a run at 1e-10: a millionth is ten times both.
  CHECK(from.value >= k_least_friction * (1.0 - 1e-8)); // the digits of the closed form
  CHECK(from.value <= k_least_friction * (1.0 + 1e-6));
  CHECK(has(from.status, "slide"));
  CHECK(bench.find("design", "holds to").value == 0.6);
  CHECK(has(first_line(outcome.out), "All limits hold if 'friction' is from 0.453746"));
  CHECK(has(first_line(outcome.out), "to 0.6 (the end of the range)."));
}

TEST_CASE("the hardest of all load cases decides, and is named") {
  StudyBench bench;
  const std::string source = "source = \"test\"\n";
  bench.write("block.toml", limited_block() + "[[case]]\nname = \"short push\"\nset = [\"signal.push.duration=0.1\"]\n" + source +
                                "[[case]]\nname = \"long push\"\nset = [\"signal.push.duration=0.2\"]\n" + source);
  const Outcome outcome =
      bench.run("model = \"block.toml\"\nkind = \"design\"\n[design]\npoints = 3\n" + k_friction + "range = [0.4, 0.6]\n");
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  const study::Finding from = bench.find("design", "holds from");
  CHECK(from.value >= k_least_friction * (1.0 - 1e-8));
  CHECK(from.value <= k_least_friction * (1.0 + 2e-4)); // the tolerance is 1e-4 if none is given
  CHECK(has(from.status, "in case 'long push'"));
}

// A mass on a spring of period 1 s that is accelerated for x s swings with 2 |sin(pi x)| of its static deflection afterwards. It stays
// within that deflection for x up to 1/6, and from 5/6 to 7/6.
TEST_CASE("all intervals of a variable that is not monotonic are found") {
  StudyBench bench;
  const Outcome outcome = bench.run(formula("1 - 2*abs(sin(pi*x))", "range = [0, 1.3]", "tolerance = 1e-9\n"));
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  const std::vector<double> ends = ends_of(bench);
  REQUIRE(ends.size() == 4);
  CHECK(ends[0] == 0.0);
  for (std::size_t i = 1; i < 4; ++i) { // the last value that holds: inside by the tolerance at most
    const double border = std::array{1.0, 5.0, 7.0}[i - 1] / 6.0;
    CHECK(ends[i] == doctest::Approx(border).epsilon(2e-9));
    CHECK(1.0 - 2.0 * std::abs(std::sin(std::acos(-1.0) * ends[i])) >= 0.0);
  }
  CHECK(has(outcome.out, "can be missed"));
  CHECK(has(outcome.out, "0.065 apart"));
}

TEST_CASE("a pair of borders between two values that are looked at is found where the margin turns") {
  StudyBench bench;
  REQUIRE(bench.run(formula("0.0001 - (x - 0.52)^2", "range = [0, 1]")).code == 0); // holds from 0.51 to 0.53; looks are 0.05 apart
  CHECK(ends_of(bench).at(0) == doctest::Approx(0.51).epsilon(1e-4));
  CHECK(ends_of(bench).at(1) == doctest::Approx(0.53).epsilon(1e-4));
}

// A limit that is exactly used everywhere holds there: failure is negative. Its border is a jump.
TEST_CASE("a limit without slope has a border, too") {
  StudyBench bench;
  REQUIRE(bench.run(formula("x < 0.3 ? 0 - x : 0", "range = [0.1, 1]")).code == 0);
  CHECK(ends_of(bench).at(0) == doctest::Approx(0.3).epsilon(1e-4));
  CHECK(ends_of(bench).at(0) >= 0.3);
}

TEST_CASE("what has no trusted result counts as not holding, and the answer says so") {
  StudyBench bench;
  const Outcome outcome = bench.run(formula("sqrt(x - 0.4)", "range = [0, 1]"));
  REQUIRE(outcome.code == 0);
  CHECK(ends_of(bench).at(0) == doctest::Approx(0.4).epsilon(1e-4));
  CHECK(ends_of(bench).at(0) >= 0.4);
  CHECK(has(outcome.out, "no trusted result and count as not holding"));
  CHECK(has(bench.find("design", "holds from").status, "has no value"));
}

TEST_CASE("no value that holds is an answer of its own, and an exit code") {
  StudyBench bench;
  const Outcome outcome = bench.run(formula("0 - 1 - (x - 0.3)^2", "range = [0, 1]"));
  CHECK(outcome.code == 5);
  CHECK(has(first_line(outcome.out),
            "All limits hold with no value of 'x' that was tried, 0 to 1. Nearest is 0.3: limit state 'limit' is negative."));
}

// A load of 1 t on n springs of 100 kN/m sinks by 98.1 mm/n; 30 mm are allowed, so that four are needed.
TEST_CASE("of whole numbers all are tried") {
  StudyBench bench;
  bench.write("hung.toml", R"(
gravity = [0, -9.81]
[simulation]
end = 0.1
initial = "equilibrium"
[[body]]
name = "load"
mass = 1000
inertia = 100
[[element]]
kind = "prismatic"
name = "guide"
a = "load"
axis = [0, 1]
[[element]]
kind = "spring_damper"
name = "springs"
a = "load"
b = { body = "ground", at = [0, 0] }
axis = [0, 1]
stiffness = 1e5
damping = 1e3
[[acceptance]]
name = "sag"
channel = "load.y"
at_least = "-30 mm"
)");
  const Outcome outcome =
      bench.run("model = \"hung.toml\"\nkind = \"design\"\n[[variable]]\nname = \"n\"\npath = \"element.springs.count\"\nrange = [1, 6]\n");
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(first_line(outcome.out) == "All limits hold if 'n' is from 4 to 6 (the end of the range).");
}

// The load of a monitored joint does not depend on the pressure, so it would slip where the pressure falls below the largest required one of
// a run: without and with interference.
TEST_CASE("the clamping with which no joint of the paper's transformer slips") {
  for (const auto& [model, wanted] : {std::pair("transformer", 29985.3745), std::pair("transformer_interference", 31977.1667)}) {
    CAPTURE(model);
    StudyBench bench;
    const Outcome outcome =
        bench.run("model = \"" STEPLAP_SOURCE "/models/studies/" + std::string(model) +
                  ".toml\"\nkind = \"design\"\n[design]\npoints = 5\ntolerance = 1e-8\n"
                  "[[variable]]\nname = \"pressure\"\npath = \"core.core.pressure\"\nrange = [\"24 kPa\", \"0.1 MPa\"]\n"
                  "[[response]]\nname = \"margin\"\nchannel = \"* joint.margin\"\nwhat = \"lowest\"\n"
                  "[[limit_state]]\nname = \"slip\"\nexpression = \"margin - 1\"\n");
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    // The runs have a tolerance of 1e-8; the wanted values are of runs at 1e-9.
    CHECK(bench.find("design", "holds from").value == doctest::Approx(wanted).epsilon(3e-7));
    CHECK(has(first_line(outcome.out), "kPa to 100 kPa (the end of the range)."));
  }
}

// R ~ N(m, m/4) and S ~ N(2, 1): beta = (m − 2)/sqrt(m²/16 + 1), which is 2.3 at m = 6.282476974. First order is exact there.
TEST_CASE("the mean resistance for a reliability index of 2.3") {
  const std::string text = "kind = \"design\"\n[design]\nbeta = 2.3\ncov = 0.02\ntolerance = 1e-8\npoints = 5\n"
                           "[[variable]]\nname = \"R\"\ndistribution = \"normal\"\ncov = 0.25\nrange = [4, 9]\n"
                           "[[variable]]\nname = \"S\"\ndistribution = \"normal\"\nmean = 2\nstandard_deviation = 1\n"
                           "[[limit_state]]\nname = \"g\"\nexpression = \"R - S\"\n";
  constexpr double k_mean = 6.282476974;
  int covered = 0;
  constexpr int k_seeds = 20;
  for (int seed = 1; seed <= k_seeds; ++seed) {
    StudyBench bench;
    const Outcome outcome = bench.run("seed = " + std::to_string(100 * seed) + "\n" + text);
    CAPTURE(outcome.err);
    CAPTURE(outcome.out);
    REQUIRE(outcome.code == 0);
    CHECK(bench.find("form", "border of first order").value == doctest::Approx(k_mean).epsilon(1e-7));
    const study::Finding from = bench.find("design", "holds from");
    CHECK(from.high - from.low < 0.02 * k_mean); // 2 % of P are 0.0076 in beta, 1.96 times that to each side; dbeta/dm is 0.277
    covered += from.low <= k_mean && k_mean <= from.high;
    CHECK(has(first_line(outcome.out), "The probability of failure is at most 0.01072 (beta at least 2.3) if the mean of 'R' is from 6."));
  }
  CHECK(covered >= 16); // of 20 intervals of 95 %: fewer have a probability of 2.6e-3
}

TEST_CASE("the mean friction with which the block slides further than 10 mm once in a thousand transports") {
  StudyBench bench;
  bench.write("block.toml", limited_block());
  const Outcome outcome = bench.run("model = \"block.toml\"\nkind = \"design\"\n[design]\np = 1e-3\npoints = 7\nconfidence = 0.999\n" +
                                    k_friction + "distribution = \"lognormal\"\ncov = 0.1\nrange = [0.5, 0.74]\n" + k_slid +
                                    "[[limit_state]]\nname = \"far\"\nexpression = \"0.01 - slid\"\n");
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  constexpr double k_mean = 0.62065089;
  CHECK(bench.find("form", "border of first order").value ==
        doctest::Approx(k_mean).epsilon(1e-4));                   // one variable: exact, to the tolerance
  const study::Finding from = bench.find("design", "holds from"); // one seed in a thousand lies outside by chance
  CHECK(from.low <= k_mean);
  CHECK(from.high >= k_mean);
  CHECK(from.high - from.low < 0.01 * k_mean); // 5 % of P are 0.015 in beta, 3.29 times that to each side; dbeta/dm is 16
}

TEST_CASE("of a list of means those are given whose probability is known to be small enough") {
  StudyBench bench;
  const Outcome outcome = bench.run("kind = \"design\"\n[design]\nbeta = 2.3\n"
                                    "[[variable]]\nname = \"R\"\ndistribution = \"normal\"\ncov = 0.25\nvalues = [5, 6, 7, 8]\n"
                                    "[[variable]]\nname = \"S\"\ndistribution = \"normal\"\nmean = 2\nstandard_deviation = 1\n"
                                    "[[limit_state]]\nname = \"g\"\nexpression = \"R - S\"\n");
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(ends_of(bench) == std::vector<double>{7.0, 8.0}); // 6.28 is needed
}

TEST_CASE("a design that cannot be made is refused with its place") {
  const auto refused = [](const std::string& text) {
    StudyBench bench;
    const Outcome outcome = bench.run(text);
    CHECK(outcome.code == 3);
    return outcome.err;
  };
  const std::string limit = "[[limit_state]]\nname = \"limit\"\nexpression = \"x + y\"\n", head = "kind = \"design\"\n",
                    x = "[[variable]]\nname = \"x\"\n", y = "[[variable]]\nname = \"y\"\n";
  CHECK(has(refused(head + x + "range = [1, 1]\n" + y + "value = 1\n" + limit), "study.toml:4:"));
  CHECK(has(refused(head + x + "range = [0, 1]\n" + y + "range = [0, 1]\n" + limit), "study.toml:5:"));
  CHECK(has(refused(head + x + "range = [0, 1]\n" + y + "range = [0, 1]\n" + limit), "seeks the value of one variable"));
  CHECK(has(refused(head + x + "value = 1\n" + y + "value = 1\n" + limit), "whose value is sought"));
  CHECK(has(refused(head + x + "range = [0, 1]\n[[limit_state]]\nname = \"limit\"\nexpression = \"1\"\n"),
            "study.toml:2:1: error: no limit depends on variable 'x'"));
  const std::string random = head + x + "range = [0, 1]\n" + y + "distribution = \"normal\"\nmean = 0\nstandard_deviation = 1\n" + limit;
  CHECK(has(refused(random), "variable 'y' has a distribution: give the target"));
  for (const char* target : {"p = 0", "p = 1", "beta = -1", "beta = 99"})
    CHECK(has(refused(random + "[design]\n" + target + "\n"), "study.toml:14:"));
  CHECK(has(refused(random + "[design]\np = 0.1\nbeta = 2\n"), "are the same target"));
  CHECK(has(refused(formula("x", "range = [0, 1]", "beta = 2\n")), "needs a [[variable]] with a distribution"));
  CHECK(has(refused("failed = \"safe\"\n" + formula("x", "range = [0, 1]")), "does not go with a design"));
  CHECK(has(refused(formula("x", "range = [0, 1]\nmean = 1\ndistribution = \"normal\"\ncov = 0.1", "beta = 2\n")), "leave 'mean' out"));
}

TEST_CASE("a case that sets the variable itself, and a model without limits, are refused") {
  StudyBench bench;
  bench.write("bare.toml", k_block);
  bench.write("block.toml",
              limited_block() +
                  "[[case]]\nname = \"slippery\"\nset = [\"element.deck friction.static_friction=0.1\"]\nsource = \"test\"\n");
  const auto text = [](const std::string& model) {
    return "model = \"" + model + "\"\nkind = \"design\"\n" + k_friction + "range = [0.4, 0.6]\n";
  };
  const Outcome own = bench.run(text("block.toml"));
  CHECK(own.code == 3);
  CHECK(has(own.err, "case 'slippery' sets 'element.deck friction.static_friction' itself"));
  CHECK(has(own.err, "block.toml:"));
  CHECK(has(bench.run(text("bare.toml")).err, "has no limits"));
}

TEST_CASE("a design study that is repeated asks for the same samples") {
  StudyBench bench;
  const std::string text = formula("x - 0.3", "range = [0, 1]");
  REQUIRE(bench.run(text).code == 0);
  const std::string before = bench.samples();
  REQUIRE(bench.run(text).code == 0);
  CHECK(bench.samples() == before);
}

// The paper's joints slide below 29.985 kPa. Their margin is then 1 to rounding, on either side of it.
TEST_CASE("a joint that slides does not hold, however its margin is rounded") {
  StudyBench bench;
  bench.write("sliding.toml", "format = 1\nextends = \"" STEPLAP_SOURCE "/models/paper/no_interference.toml\"\n[simulation]\n"
                              "integrator = \"dop853\"\ntolerance = 1e-8\n");
  const std::string model = "model = \"sliding.toml\"\n",
                    pressure = "[[variable]]\nname = \"pressure\"\npath = \"core.core.pressure\"\nvalues = [\"26 kPa\", \"28 kPa\", \"31 "
                               "kPa\"]\n",
                    margin = "[[response]]\nname = \"margin\"\nchannel = \"* joint.margin\"\nwhat = \"lowest\"\n";
  const auto limit = [](const std::string& expression) {
    return "[[limit_state]]\nname = \"slip\"\nexpression = \"" + expression + "\"\n";
  };
  // 1.01 margin − 1.01 is rounded to zero or to either side of it where margin − 1 is not.
  for (const std::string expression : {"margin - 1", "1.01*margin - 1.01", "1e6*(margin - 1)"}) {
    CAPTURE(expression);
    const Outcome outcome = bench.run(model + "kind = \"design\"\n" + pressure + margin + limit(expression), {"--restart"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(has(first_line(outcome.out), "All limits hold if 'pressure' is at 31 kPa."));
    CHECK(has(bench.find("design", "holds from").status, "'slip' is negative"));
  }
  const Outcome sweep = bench.run(model + "kind = \"sweep\"\n" + pressure + margin + limit("margin - 1"), {"--restart"});
  CHECK(sweep.code == 0);
  CHECK(bench.find("sweep", "lowest", "slip").value < -1e-10);
}

// The tank slides on the floor at every pressure, so that its friction has the share 1: its load is its capacity, by structure.
TEST_CASE("a limit state that is zero to rounding on a whole stretch is open and does not hold") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const std::string model = "model = \"block.toml\"\n", share = "[[response]]\nname = \"share\"\nchannel = \"deck friction.share\"\n"
                                                                "what = \"highest\"\n[[limit_state]]\nname = \"grip\"\nexpression = ";
  for (const std::string expression : {"1 - share", "0.7 - 0.7*share", "share - 1"}) { // of unknown sign either way round
    CAPTURE(expression);
    const Outcome design = bench.run(model + "kind = \"design\"\n[design]\npoints = 5\n" + k_friction + "range = [0.2, 0.4]\n" + share +
                                         "\"" + expression + "\"\n",
                                     {"--restart"});
    CHECK(design.code == 5);
    CHECK(has(first_line(design.out), "with no value of 'friction'"));
    CHECK(has(design.out, "'grip' is zero to the rounding of the run"));
    CHECK(has(design.out, "5 values have no trusted result"));
  }
  const Outcome sweep =
      bench.run(model + "kind = \"sweep\"\n" + k_friction + "values = [0.2, 0.3]\n" + share + "\"1 - share\"\n", {"--restart"});
  CHECK(sweep.code == 5);
  CHECK(has(bench.samples(), "1,undecided,"));
  // By sampling nothing is known either: the bounds are 0 and 1 where all blocks slide.
  const Outcome reliability =
      bench.run(model + "kind = \"reliability\"\n[reliability]\nmethods = [\"monte_carlo\", \"form\"]\nsamples = 100\n" + k_friction +
                    "distribution = \"uniform\"\nlow = 0.2\nhigh = 0.4\n" + share + "\"1 - share\"\n",
                {"--restart"});
  CHECK(reliability.code != 0);
  CHECK(bench.find("monte_carlo", "probability, runs without result as safe").value == 0.0);
  CHECK(bench.find("monte_carlo", "probability, runs without result as unsafe").value == 1.0);
}

// Zeros without rounding hold as before: a code of the friction of a block that sticks, and the number of its slips.
TEST_CASE("a limit state that is exactly zero holds") {
  StudyBench bench;
  bench.write("block.toml", k_block); // 0.6 g: it slides below a friction of 0.6
  for (const std::string expression : {"1 - mode", "0 - slips"}) {
    CAPTURE(expression);
    const Outcome outcome = bench.run("model = \"block.toml\"\nkind = \"design\"\n[design]\npoints = 5\n" + k_friction +
                                          "range = [0.5, 0.7]\n[[response]]\nname = \"mode\"\nchannel = \"deck friction.mode\"\nwhat = "
                                          "\"highest\"\n[[response]]\nname = \"slips\"\nwhat = "
                                          "\"count\"\nevent = \"slips*\"\n[[limit_state]]\nname = \"firm\"\nexpression = \"" +
                                          expression + "\"\n",
                                      {"--restart"});
    CAPTURE(outcome.err);
    CAPTURE(outcome.out);
    REQUIRE(outcome.code == 0);
    CHECK(bench.find("design", "holds from").value == doctest::Approx(0.6).epsilon(1e-4));
  }
}

// x springs of 1 kN/m each and y of 3 kN/m carry 5 kN/m or more. They cost 1 and 2 each.
TEST_CASE("the cheapest of all options that hold is chosen, and the dearer ones are listed") {
  StudyBench bench;
  const std::string text = "kind = \"design\"\n[design]\ncost = \"x + 2*y\"\n[[variable]]\nname = \"x\"\nvalues = [0, 1, 2, 3, 4, 5]\n"
                           "[[variable]]\nname = \"y\"\nvalues = [0, 1, 2]\n"
                           "[[limit_state]]\nname = \"stiffness\"\nexpression = \"x + 3*y - 5\"\n";
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  // 2 + 3 = 5 costs 4; so does 0 + 6, the first in the order of the grid. 5 and 0 cost 5.
  CHECK(has(first_line(outcome.out), "The cheapest of 11 options that hold, of 18 tried, is 'x' = 0, 'y' = 2 at a cost of 4."));
  CHECK(has(first_line(outcome.out), "does not hold: limit state 'stiffness' is negative"));
  double last = 0.0;
  for (int k = 1; k <= 11; ++k) {
    const std::string name = "option " + std::to_string(k);
    const double x = bench.find("design", "x", name).value, y = bench.find("design", "y", name).value;
    const double cost = bench.find("design", "cost", name).value;
    CHECK(x + 3.0 * y >= 5.0);
    CHECK(cost == x + 2.0 * y);
    CHECK(cost >= last);
    last = cost;
  }
  CHECK(bench.find("design", "margin", "option 12").value < 0.0); // those that do not hold come last
}

TEST_CASE("a cheaper option whose result is unknown leaves the choice open") {
  StudyBench bench;
  const auto text = [](const std::string& limit) {
    return "kind = \"design\"\n[design]\ncost = \"x\"\n[[variable]]\nname = \"x\"\nvalues = [1, 2, 3]\n[[limit_state]]\nname = "
           "\"limit\"\nexpression = \"" +
           limit + "\"\n";
  };
  const Outcome open = bench.run(text("sqrt(x - 1.5)"));
  CHECK(open.code == 5);
  CHECK(has(open.out, "1 cheaper option is open"));
  CHECK(has(first_line(open.out), "is 'x' = 2 at a cost of 2."));
  const Outcome none = bench.run(text("x - 4"), {"--restart"});
  CHECK(none.code == 5);
  CHECK(has(first_line(none.out), "None of 3 options holds. Nearest is 'x' = 3: limit state 'limit' is negative"));
}

TEST_CASE("a choice that cannot be made is refused with its place") {
  const auto refused = [](const std::string& cost, const std::string& variable, const std::string& more = "") {
    StudyBench bench;
    const Outcome outcome = bench.run("kind = \"design\"\n[design]\ncost = \"" + cost + "\"\n" + more + "[[variable]]\nname = \"x\"\n" +
                                      variable + "\n[[limit_state]]\nname = \"limit\"\nexpression = \"x\"\n");
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, "study.toml:"));
    return outcome.err;
  };
  CHECK(has(refused("x", "range = [0, 1]"), "is among 'values'"));
  CHECK(has(refused("y", "values = [0, 1]"), "'y'"));
  CHECK(has(refused("1/x", "values = [0, 1]"), "has no finite value"));
  CHECK(has(refused("x", "values = [0, 1]", "p = 0.1\n"), "hold for certain"));
}
