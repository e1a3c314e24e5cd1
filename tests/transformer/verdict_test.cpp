// The verdict on a run: criteria of the model, and the step-lap joints' own.
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judge.h"
#include "mbd/trust/weighed_errors.h"
#include "tests/transformer/swing.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;

namespace {

// A mass thrown upwards from a floor that it leaves at once: y = v t − g t²/2 exactly, v = g/2, so that it
// is highest, 1.22625 m above the floor's contact, at t = 0.5 s.
const std::string k_throw = R"(
title = "a throw"
[simulation]
end = 0.9
step = 1e-3
[output]
step = 0.1
[[body]]
name = "ball"
mass = 1
inertia = 1
position = [0, 1]
velocity = [0, 4.905]
)";

const std::string k_floor = R"(
[[element]]
kind = "unilateral_contact"
name = "floor"
a = { body = "ball", at = [0, 0.9] }
normal = [0, 1]
stiffness = 1e4
gap = 0.1
)";

struct Judged {
  Model model;
  std::unique_ptr<System> system;
  RunResult result;
  Judgement judgement;

  explicit Judged(const std::string& criteria, const std::string& failure = "")
      : model(parse_model(k_throw + criteria, "a.toml", transformer_catalog())), system(compile(model)) {
    check_presentation(model, *system);
    result = simulate(*system, system->initial_state(), options_of(model));
    judgement = judge(model, *system, result, failure);
  }
  [[nodiscard]] const CriterionResult& only() const {
    REQUIRE(judgement.criteria.size() == 1);
    return judgement.criteria.front();
  }
};

std::string acceptance(const std::string& fields) { return "[[acceptance]]\nname = \"c\"\n" + fields; }

} // namespace

TEST_CASE("limits on either side and on the absolute value") {
  // Samples every 0.1 s hold the highest point; parabola and rk4 agree to rounding.
  const double top = 1.0 + 0.5 * 4.905 * 0.5;
  SUBCASE("met") {
    const Judged run(acceptance("channel = \"ball.y\"\nat_most = \"2.3 m\"\n"));
    CHECK(run.judgement.verdict == Verdict::hold);
    CHECK(*run.only().value == doctest::Approx(top).epsilon(1e-12));
    CHECK(*run.only().t == doctest::Approx(0.5));
    CHECK(*run.only().limit == 2.3);
    CHECK(run.only().text == "ball.y <= 2.3 m");
  }
  SUBCASE("too high") {
    const Judged run(acceptance("channel = \"ball.y\"\nat_most = 2.2\nconsequence = \"reject\"\n"));
    CHECK(run.judgement.verdict == Verdict::reject);
    CHECK(run.only().outcome == Verdict::reject);
  }
  SUBCASE("too low: the limit that is broken is the one that is told") {
    const Judged run(acceptance("channel = \"ball.y\"\nat_least = 1.3\nat_most = 9\n"));
    CHECK(run.judgement.verdict == Verdict::inspect);
    CHECK(*run.only().limit == 1.3);
    CHECK(*run.only().value == doctest::Approx(1.0));
    CHECK(*run.only().t == 0.0);
  }
  SUBCASE("absolute value: the fall is as fast as the throw, samples end before it is") {
    CHECK(Judged(acceptance("channel = \"ball.vy\"\nwithin = 4.91\n")).judgement.verdict == Verdict::hold);
    CHECK(Judged(acceptance("channel = \"ball.vy\"\nwithin = 4.90\n")).judgement.verdict == Verdict::inspect);
  }
  SUBCASE("patterns: the worst of all channels") {
    const Judged run(acceptance("channel = \"ball.v?\"\nat_most = 100\n"));
    CHECK(run.only().where == "ball.vy");
  }
}

TEST_CASE("a limit is what its text means in the channel's unit") {
  const auto limit = [](const std::string& channel, const std::string& text) {
    return *Judged(acceptance("channel = \"" + channel + "\"\nwithin = " + text + "\n")).only().limit;
  };
  CHECK(limit("ball.y", "\"2500 mm\"") == doctest::Approx(2.5).epsilon(1e-15));
  CHECK(limit("ball.y", "2.5") == 2.5);
  CHECK(limit("ball.theta", "\"180 deg\"") == doctest::Approx(M_PI).epsilon(1e-15));
  CHECK(limit("ball.omega", "\"60 rpm\"") == doctest::Approx(2.0 * M_PI).epsilon(1e-15));
  CHECK(limit("ball.ay", "\"2 gravity\"") == doctest::Approx(2.0 * 9.80665).epsilon(1e-15));
}

TEST_CASE("a run that stopped is not held good, nor one without criteria") {
  CHECK(Judged(acceptance("channel = \"ball.y\"\nat_most = 3\n"), "step size").judgement.verdict == Verdict::open);
  // Open whatever came before, which is told beside it.
  const Judged broken(acceptance("channel = \"ball.y\"\nat_most = 1\n"), "step size");
  CHECK(broken.judgement.verdict == Verdict::open);
  CHECK(broken.judgement.so_far == Verdict::inspect);
  const Judged without("");
  CHECK_FALSE(without.judgement.has_criteria);
  CHECK(without.judgement.verdict == Verdict::open);
}

TEST_CASE("events that must not happen") {
  const Judged landed(k_floor + acceptance("event = \"closes\"\nelement = \"fl*\"\n"));
  CHECK(landed.judgement.verdict == Verdict::hold); // it is still in the air at 0.9 s
  Model longer =
      parse_model(k_throw + k_floor + acceptance("event = \"closes\"\n"), "a.toml", transformer_catalog(), {"simulation.end=1.2"});
  const auto system = compile(longer);
  const RunResult result = simulate(*system, system->initial_state(), options_of(longer));
  const Judgement judgement = judge(longer, *system, result, "");
  CHECK(judgement.verdict == Verdict::inspect);
  CHECK(judgement.criteria.front().where == "floor");
  // Back at the gap of 0.1 m below the start: v t − g t²/2 = −0.1.
  CHECK(*judgement.criteria.front().t == doctest::Approx((4.905 + std::sqrt(4.905 * 4.905 + 2.0 * 9.81 * 0.1)) / 9.81).epsilon(1e-10));
}

TEST_CASE("step-lap joints are held to their own criterion") {
  const auto judge_paper = [](const char* file) {
    const Model model = read_model(std::string(STEPLAP_MODELS) + file, transformer_catalog(),
                                   {"simulation.integrator=dop853", "simulation.tolerance=1e-8"});
    const auto system = compile(model);
    const RunResult result = simulate(*system, system->initial_state(), options_of(model));
    return judge(model, *system, result, "");
  };
  CHECK(judge_paper("/paper/no_interference.toml").verdict == Verdict::hold);
  const Judgement weak = judge_paper("/paper/weak_clamping.toml");
  CHECK(weak.verdict == Verdict::inspect);
  CHECK(std::count_if(weak.criteria.begin(), weak.criteria.end(), [](const CriterionResult& c) {
          return c.text == "the step-lap joint holds" && c.outcome == Verdict::inspect && c.t;
        }) == 2);
}

namespace {

Judgement judge_layout(const std::string& file, const std::vector<std::string>& overrides) {
  const Model model = read_model(std::string(STEPLAP_MODELS) + "/layouts/" + file, transformer_catalog(), overrides);
  const auto system = compile(model);
  const RunResult result = simulate(*system, system->initial_state(), options_of(model));
  return judge(model, *system, result, "");
}

const CriterionResult* find(const Judgement& judgement, const std::string& name, const std::string& part) {
  const auto found = std::find_if(judgement.criteria.begin(), judgement.criteria.end(),
                                  [&](const CriterionResult& c) { return c.name == name && c.text.find(part) != std::string::npos; });
  return found == judgement.criteria.end() ? nullptr : &*found;
}

} // namespace

TEST_CASE("what slides from the start is seen by a criterion on events, the way it slides, at an exact time") {
  const std::string scene = R"(
title = "a block that slides"
[simulation]
end = 0.1
integrator = "tsit5"
[output]
step = 0.05
[[body]]
name = "block"
mass = 1
inertia = 1
velocity = [1, 0]
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "block"
b = "ground"
normal = [0, 1]
stiffness = 1e4
preload = 9.81
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = 0.3
[[acceptance]]
name = "stays"
event = ")";
  const auto judged = [&](const std::string& event, const char* friction) {
    const Model model =
        parse_model(scene + event + "\"\n", "a.toml", transformer_catalog(), {std::string("element.friction.static_friction=") + friction});
    const auto system = compile(model);
    const RunResult result = simulate(*system, system->initial_state(), options_of(model));
    Judgement judgement = judge(model, *system, result, "");
    weigh_errors(judgement, model, *system, result, estimate_global_error(*system, system->initial_state(), options_of(model), result));
    return judgement.criteria.front();
  };
  for (const char* event : {"slips forward", "slips*"}) {
    const CriterionResult c = judged(event, "0.3");
    CHECK(c.outcome == Verdict::inspect);
    CHECK(c.where == "friction");
    CHECK(c.t == 0.0);
    CHECK(c.t_error == 0.0);
  }
  CHECK(judged("slips backward", "0.3").outcome == Verdict::hold);
  CHECK(judged("slips*", "0").outcome == Verdict::hold); // without friction there is nothing that could hold
}

TEST_CASE("a joint's verdict needs nothing of what is written") {
  // At 20 kPa the joints would need 27.6 kPa: monitored, with no channel of theirs written.
  const Judgement judgement = judge_layout("three_limb_humping.toml", {"output.channels=[\"active part.*\"]", "core.core.pressure=20000",
                                                                       "core.core.mode=monitor", "simulation.end=0.25"});
  CHECK(judgement.verdict == Verdict::inspect);
  const CriterionResult* joint = find(judgement, "front joint", "holds");
  REQUIRE(joint);
  CHECK(joint->outcome == Verdict::inspect);
  REQUIRE(joint->value);
  CHECK(*joint->value < 1.0);
}

TEST_CASE("a limb that falls out is rejected as soon as a corner has parted") {
  const Judgement judgement =
      judge_layout("three_limb.toml", {"core.core.static_friction=0.1", "core.core.pressure=50000", "core.core.sheets_per_layer=2",
                                       "core.core.bands=mean", "simulation.end=0.4", "output.step=0.1"});
  CHECK(judgement.verdict == Verdict::reject);
  const CriterionResult* slid = find(judgement, "front joint", "displacement of its corners");
  REQUIRE(slid);
  CHECK(slid->outcome == Verdict::reject);
  CHECK(*slid->value > 1.0); // of the overlap's width
  const CriterionResult* parted = find(judgement, "front joint", "no corner parts");
  REQUIRE(parted);
  CHECK(*parted->value == 0.0);
  CHECK(*parted->t < 0.4);
  CHECK(find(judgement, "front joint", "the step-lap joint holds")->outcome == Verdict::inspect); // not wholly apart
}

TEST_CASE("every pattern of the channels that are written matches one") {
  Model model = parse_model(k_throw, "a.toml", transformer_catalog());
  const std::unique_ptr<System> system = compile(model);
  const auto message = [&](const std::string& pattern) -> std::string {
    model.output.channels = {"ball.x", pattern};
    try {
      check_written_channels(model, *system);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message("ball.v*") == "");
  CHECK(message("nothing.*") == "a.toml:6:1: error: 'channels' of [output]: no channel matches 'nothing.*'");
  CHECK(message("bal.y").find("no channel matches 'bal.y' (did you mean 'ball.y'?)") != std::string::npos);
  CHECK(message("whole.bal*").find("'whole.balance' is computed on request only") != std::string::npos);
}

TEST_CASE("criteria and plots that make no sense are errors of the model") {
  const auto message = [](const std::string& tables) -> std::string {
    try {
      const Judged run(tables);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  const auto says = [&](const std::string& tables, const std::string& part) {
    const std::string text = message(tables);
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  says(acceptance("channel = \"ball.y\"\n"), "needs a limit");
  says(acceptance("at_most = 1\n"), "needs either 'channel' or 'event'");
  says(acceptance("channel = \"ball.y\"\nat_most = 1\nat_least = 2\n"), "nothing could meet it");
  says(acceptance("channel = \"ball.y\"\nat_most = 1\nwithin = 2\n"), "'within' bounds both sides");
  says(acceptance("event = \"opens\"\nat_most = 1\n"), "are for channels");
  says(acceptance("channel = \"bell.y\"\nat_most = 1\n"), "did you mean 'ball.y'?");
  says(acceptance("channel = \"ball.y\"\nat_most = 1\nconsequence = \"burn\"\n"), "burn");
  says(acceptance("channel = \"ball.y\"\nat_most = 1\n") + acceptance("channel = \"ball.y\"\nat_most = 1\n"), "exists already");
  says(acceptance("event = \"opens\"\nelement = \"feet\"\n"), "no element matches 'feet'");
  // Limits are read in the channel's unit, and messages point at the field.
  says(acceptance("channel = \"ball.y\"\nat_most = \"3 s\"\n"),
       "a.toml:17:11: error: acceptance 'c': 'at_most' of channel 'ball.y': '3 s' has the unit 's', but a unit like 'm' is needed");
  says(acceptance("channel = \"ball.theta\"\nwithin = \"2 mm\"\n"),
       "a.toml:17:10: error: acceptance 'c': 'within' of channel 'ball.theta': '2 mm'");
  says(acceptance("channel = \"ball.y\"\nat_most = \"much\"\n"), "a.toml:17:11: error: 'at_most' of acceptance 'c'");
  says(acceptance("channel = \"ball.y\"\nwithin = \"-1 m\"\n"), "'within' must be at least 0, got -1");
  says(acceptance("channel = \"ball.y\"\nwithin = nan\n"), "must be finite");
  says(acceptance("channel = \"ball.*y\"\nat_most = 1\n"),
       "a.toml:16:11: error: acceptance 'c': 'ball.y' is in 'm', 'ball.vy' in 'm/s': limit them apart");
  says(k_floor + acceptance("event = \"opns\"\n"), "no event of the model is called 'opns' (did you mean 'opens'?)");
  says(k_floor + acceptance("event = \"slipps\"\nelement = \"floor\"\n"), "no event of 'floor' is called 'slipps'");
  says(acceptance("event = \"opens\"\n"), "nothing of the model has events");
  says(acceptance("element = \"feet\"\nevent = \"opens\"\n"), "a.toml:16:11: error: acceptance 'c': no element matches 'feet'");
  says("[[plot]]\nname = \"p\"\nchannels = [\"ball.y\"]\nbounds = [\"ball.vy\"]\n", "a.toml:17:10: error: plot 'p'");
  says("[[plot]]\nname = \"p\"\nchannels = [\"ball.y\", \"ball.vy\"]\n", "plot them apart");
  says("[[plot]]\nname = \"p\"\nchannels = [\"ball.z\"]\n", "no channel matches 'ball.z'");
  says("[[plot]]\nname = \"p\"\nchannels = [\"whole.bal*\"]\n",
       "'whole.balance' is computed on request only: add also = [\"whole.balance\"]");
  says("[[plot]]\nname = \"p\"\n", "channels");
}

namespace {

// ½ m v² = 0.5 J goes to and fro, 2 Hz: implicit Euler with steps of h loses ω h = 0.126 of it in each radian at 0.01 s.
const std::string k_swing = swing("[simulation]\nend = 1.0\nstep = 0.01\n[output]\nstep = 0.1\n", "1", "158");

Judgement judged_swing(const std::string& settings, const std::string& text = k_swing) {
  std::string all = text;
  all.insert(all.find("end = "), settings + "\n");
  const Model model = parse_model(all, "swing.toml", transformer_catalog());
  const std::unique_ptr<System> system = compile(model);
  const RunResult result = simulate(*system, system->initial_state(), options_of(model));
  return judge(model, *system, result, "");
}

} // namespace

TEST_CASE("a run whose energy does not balance is not to be trusted, and says what to try") {
  const Judgement bad = judged_swing("integrator = \"moreau\"");
  CHECK(bad.distrust.find("the energy balance is off by") != std::string::npos);
  CHECK(bad.distrust.find("try a step of 0.001 s, or the integrator auto") != std::string::npos);
  CHECK(bad.verdict == Verdict::open);
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4"}) {
    CAPTURE(method);
    CHECK(judged_swing("integrator = \"" + std::string(method) + "\"").distrust.empty());
  }
  CHECK(judged_swing("integrator = \"rodas5p\"\ntolerance = 1e-3").distrust.empty());
}

TEST_CASE("coordinates whose rounding is a motion are not to be trusted, a fast train is") {
  // After a second at 1e12 m/s positions are known to 2e-4 m, of a body of 1 m; at 1e6 m/s to 2e-10 m.
  CHECK(judged_swing("velocity = [0, 1e12]").distrust.find("positions of 1e+12 m are known to") == 0);
  CHECK(judged_swing("velocity = [0, 1e6]").distrust.empty());
}

// x = 0.1 cos 10 t: in 10 s steps of 0.1 s lose (ωh)⁶/144 of the energy a step and turn by (ωh)⁵/120 too little, 0.8 rad in all.
TEST_CASE("fixed steps that differ from two adaptive runs which agree are called wrong; fine ones are not") {
  const auto distrust_at = [](const char* step) {
    const Model model = parse_model(R"(
gravity = [0, 0]
[simulation]
end = 10
integrator = "rk4"
[output]
step = 0.05
[[body]]
name = "mass"
mass = 1.0
inertia = 1.0
position = [0.1, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
preload = -10.0
stiffness = 100.0
)",
                                    "a.toml", transformer_catalog(), {std::string("simulation.step=") + step});
    const auto system = compile(model);
    const RunResult result = simulate(*system, system->initial_state(), options_of(model));
    Judgement judgement = judge(model, *system, result, "");
    judgement.distrust.clear(); // of its energy
    weigh_errors(judgement, model, *system, result, estimate_global_error(*system, system->initial_state(), options_of(model), result));
    return judgement.distrust;
  };
  const std::string coarse = distrust_at("0.1");
  CAPTURE(coarse);
  CHECK(coarse.find("two runs by auto at tolerances of 1e-09 and 1e-11 agree, and this one is off by ") == 0);
  CHECK(coarse.find("in 'mass.x': the fixed steps are wrong") != std::string::npos);
  CHECK(distrust_at("1e-3").empty());
}
