// Ties beside a joint: slack, preload, strength, what is stored when one breaks, and who bears what.
#include "mbd/trust/judge.h"
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace step_lap_scene;
using steplap::Vec2;

namespace {

constexpr double k_pi = std::numbers::pi;

std::string tie(const std::string& fields, const std::string& name = "tie") {
  return "[[element]]\nkind = \"tie\"\nname = \"" + name + "\"\na = \"block\"\naxis = [1.0, 0.0]\n" + fields + "\n";
}

std::string block(const std::string& simulation, double output_step, const Vec2& velocity, const std::string& more) {
  return header(simulation, output_step) + body("block", 2.0, 1.0, {0.0, 0.0}, velocity) + more;
}

} // namespace

TEST_CASE("a tie with slack lets go of a block as fast as it caught it, and pulls only") {
  // Caught at slack/v, held for half a period.
  const double w = std::sqrt(5e4 / 2.0), v = 0.4, slack = 2e-3;
  for (const auto& [integrator, how] :
       {std::pair{"dop853", "tolerance = 1e-11"}, {"rk4", "step = 1e-5"}, {"rodas5p", "tolerance = 1e-11"}}) {
    CAPTURE(integrator);
    const Run r = run_text(block(std::string("end = 0.06\nintegrator = \"") + integrator + "\"\n" + how, 0.06, {v, 0.0},
                                 tie("stiffness = 5e4\nslack = 2e-3")));
    const auto taut = r.times("tie", "closes its gap"), loose = r.times("tie", "enters its gap");
    REQUIRE(taut.size() == 1);
    REQUIRE(loose.size() == 1);
    CHECK(std::abs(taut[0] - slack / v) < 1e-9);
    CHECK(std::abs(loose[0] - slack / v - k_pi / w) < 1e-8);
    CHECK(r.last("block.vx") == doctest::Approx(-v).epsilon(1e-7));
    CHECK(r.last("tie.force") == 0.0); // beyond the slack on the other side: it does not press
    CHECK(r.last("block.x") < -slack);
  }
}

TEST_CASE("a tie that acts both ways is a spring with its preload") {
  const Run r = run_text(block("end = 0.1\nintegrator = \"dop853\"\ntolerance = 1e-12", 0.01, {0.0, 0.0},
                               tie("acts = \"both\"\nstiffness = 5e4\npreload = 100.0\ncount = 2")));
  const double w = std::sqrt(1e5 / 2.0), at = -100.0 / 1e5; // swings about where the preload is gone
  const auto x = r.series("block.x"), f = r.series("tie.force");
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(std::abs(x[i] - at * (1.0 - std::cos(w * 0.01 * static_cast<double>(i)))) < 1e-12);
    CHECK(f[i] == doctest::Approx(1e5 * (x[i] - at)).epsilon(1e-12));
  }
}

TEST_CASE("a tie breaks at its strength: what it had stored is dissipated, and it bears nothing more") {
  // 150 N of a spring of 5e4: at 3 mm. ½ m v² − ½ F²/k is left to the block.
  const double k = 5e4, strength = 150.0, v = 0.6, w = std::sqrt(k / 2.0);
  for (const auto& [integrator, how] : {std::pair{"dop853", "tolerance = 1e-11"},
                                        {"rk4", "step = 1e-5"},
                                        {"rodas5p", "tolerance = 1e-11"},
                                        {"auto", "tolerance = 1e-11"}}) {
    CAPTURE(integrator);
    const Run r = run_text(block(std::string("end = 0.05\nintegrator = \"") + integrator + "\"\n" + how, 0.05, {v, 0.0},
                                 tie("stiffness = 5e4\nstrength = 150.0")));
    const auto breaks = r.times("tie", "breaks");
    REQUIRE(breaks.size() == 1);
    CHECK(std::abs(breaks[0] - std::asin(strength / k * w / v) / w) < 1e-9);
    CHECK(r.result.statistics.dissipated == doctest::Approx(0.5 * strength * strength / k).epsilon(1e-9));
    CHECK(r.last("block.vx") == doctest::Approx(std::sqrt(v * v - strength * strength / (2.0 * k))).epsilon(1e-9));
    CHECK(r.last("tie.force") == 0.0);
    CHECK(r.last("tie.mode") == 0.0);
    CHECK(r.relative_energy_residual() < 1e-9);
  }
}

TEST_CASE("a tie that must not break ends the run, and a broken one is rejected") {
  const auto model = [](const std::string& fields) {
    return steplap::parse_model(
        block("end = 0.05\nintegrator = \"dop853\"\ntolerance = 1e-10", 1e-3, {0.6, 0.0}, tie("stiffness = 5e4\n" + fields)), "scene.toml",
        steplap::transformer_catalog());
  };
  const Run stopped = run(model("strength = 150.0\non_break = \"stop\""));
  CHECK(stopped.result.trajectory->times().back() < 0.01);
  const auto outcome = [&](const std::string& fields) {
    const steplap::Model m = model(fields);
    const Run r = run(m);
    for (const steplap::CriterionResult& c : steplap::judge(m, *r.system, r.result, "").criteria)
      if (c.name == "tie") return c.outcome;
    return steplap::Verdict::open;
  };
  CHECK(outcome("strength = 150.0") == steplap::Verdict::reject);
  CHECK(outcome("strength = 250.0") == steplap::Verdict::hold); // 0.6/w · k = 190 N
}

TEST_CASE("a flitch plate beside an elastic joint: a preloaded one relieves it, a weak one breaks and hands its load on") {
  const auto scene = [](const std::string& plate, const std::string& end) {
    return header("end = " + end + "\nintegrator = \"auto\"\ntolerance = 1e-9", 1.0) + body("limb", 10.0, 1.0, {0.0, 0.0}) +
           joint("limb", "ground", "tangential_stiffness = 1e6") +
           interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2) +
           "[[signal]]\nname = \"ramp\"\nkind = \"triangle\"\npeak = 1000.0\nduration = 20.0\n"
           "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"limb\"\nforce_x = \"ramp\"\n"
           "[[element]]\nkind = \"tie\"\nname = \"plate\"\na = \"limb\"\naxis = [1.0, 0.0]\nstiffness = 5e5\ndamping = "
           "1e3\nacts = \"both\"\n" +
           plate;
  };
  // Joint K = 1e6, plate k = 5e5: the joint yields at 400 N, the plate bearing 200 N then (t = 6 s).
  const Run whole = run_text(scene("", "8.0"));
  REQUIRE(whole.times("joint", "slips").size() >= 1);
  CHECK(std::abs(whole.times("joint", "slips")[0] - 6.0) < 1e-2);           // the damper's lag
  CHECK(whole.last("plate.force") == doctest::Approx(400.0).epsilon(1e-3)); // of 800 N
  // Weak: breaks at 100 N (300 N of load), whereupon the joint bears all, until 400 N at 4 s.
  const Run weak = run_text(scene("strength = 100.0\n", "4.2"));
  REQUIRE(weak.times("plate", "breaks").size() == 1);
  CHECK(std::abs(weak.times("plate", "breaks")[0] - 3.0) < 1e-2);
  REQUIRE(weak.times("joint", "slips").size() >= 1);
  CHECK(weak.times("joint", "slips")[0] < 4.0); // it swings: what the plate had borne comes at once
}

TEST_CASE("what a tie cannot be is refused with the reason") {
  const auto refusal = [](const std::string& fields) -> std::string {
    try {
      run_text(block("end = 1.0\nintegrator = \"auto\"", 1.0, Vec2::Zero(), tie("stiffness = 5e4\n" + fields)));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("preload = 10.0\nslack = 1e-3").find("not both") != std::string::npos);
  CHECK(refusal("preload = -10.0").find("presses") != std::string::npos);
  CHECK(refusal("preload = 100.0\nstrength = 50.0").find("beyond its 'strength'") != std::string::npos);
  CHECK(refusal("on_break = \"stop\"").find("needs a 'strength'") != std::string::npos);
}
