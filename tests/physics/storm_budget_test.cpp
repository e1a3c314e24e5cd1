// Time stepping through a storm of events may halve its steps only so often: then events are the cheaper way.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A ladder of 4 m at 30° on smooth ground that leans on a wall with a friction of 1e6: both ends rattle at the start, a
// storm. Beside it light balls fall onto plates whose dampers make their forces jump on closing, within m/c = 1e-9 s: steps of
// 1e-5 s have no consistent end there and are halved.
std::string scene_text() {
  const double half = 2.0, x = half * std::cos(M_PI / 6.0), y = half * std::sin(M_PI / 6.0);
  const auto number = [](double value) { return std::to_string(value); };
  std::string text =
      body("ladder", "mass = 20; inertia = " + number(20.0 * 16.0 / 12.0) + "; position = [" + number(x) + ", " + number(y) + "]");
  const auto end = [&](const std::string& name, double px, double py, const std::string& normal, const std::string& friction) {
    text += element("unilateral_contact", name,
                    "a = { body = \"ladder\", point = [" + number(px) + ", " + number(py) +
                        "] }; b = \"ground\"; gap = 0.0; normal = " + normal + "; stiffness = 1e7; damping = 2e3");
    text += element("coulomb_stick", name + " friction", "contacts = [\"" + name + "\"]; static_friction = " + friction);
  };
  end("foot", x, -y, "[0.0, 1.0]", "0.3");
  end("top", -x, y, "[1.0, 0.0]", "1e6");
  for (int i = 0; i < 20; ++i) {
    const std::string ball = "ball " + std::to_string(i);
    text += body(ball, "mass = 1e-3; inertia = 1e-3; velocity = [0.0, -1.0]; position = [" + number(10.0 + i) + ", 0.0]");
    text += element("unilateral_contact", "plate " + std::to_string(i),
                    "a = \"" + ball + "\"; b = \"ground\"; gap = " + number(4e-4 + 5e-5 * i) +
                        "; normal = [0.0, 1.0]; stiffness = 1e3; damping = 1e6");
  }
  return text;
}

struct Storms {
  double longest = 0.0; ///< s
  long count = 0;
};

Storms storms_of(long parts) {
  const auto system = compile(scene(scene_text() + "[simulation]\nstep = 1e-3\n"));
  SimulationOptions o = options({"auto", 1e-8, 0.003});
  o.storm_parts = parts;
  const RunResult result = simulate(*system, system->initial_state(), o);
  Storms storms;
  storms.count = result.statistics.storms;
  double begin = 0.0;
  for (const Event& event : result.events) {
    if (event.kind == EventKind::storm) begin = event.t;
    if (event.kind == EventKind::event_storm_ends) storms.longest = std::max(storms.longest, event.t - begin);
  }
  return storms;
}

} // namespace

// A box of 10 kg on stiff contacts (700 kHz) and a deck shaken at 30 and 173 kHz, for 0.3 ms: some fifty events in that
// time are the scene's own pace. What it takes at most, 8.69 MN, is known from dop853, which knows no storms.
TEST_CASE("storms: events at the pace of a drive are followed one by one") {
  const Model model = read_model(STEPLAP_TEST_DATA "/box_on_ultrasonic_deck.toml", transformer_catalog());
  const auto system = compile(model);
  double largest[2] = {};
  for (int i = 0; i < 2; ++i) {
    SimulationOptions o = options_of(model);
    o.integrator = i == 0 ? "auto" : "dop853";
    const RunResult result = simulate(*system, system->initial_state(), o);
    CHECK(result.statistics.storms == 0);
    for (const ChannelRange& range : result.ranges)
      if (range.channel->name == "fr.friction") largest[i] = std::abs(range.largest().value);
  }
  CHECK(largest[1] == doctest::Approx(8.69e6).epsilon(1e-3));
  CHECK(largest[0] == doctest::Approx(largest[1]).epsilon(1e-4));
}

TEST_CASE("storm budget: time stepping gives the run back to events once its steps were halved so often") {
  const Storms whole = storms_of(1000000);
  REQUIRE(whole.count >= 1);
  CHECK(whole.longest == doctest::Approx(2e-3).epsilon(1e-9)); // all of the interval
  // With a budget of one part a storm ends with the first step that is halved twice: by 0.45 ms, when the second ball lands.
  const Storms cut = storms_of(1);
  REQUIRE(cut.count >= 1);
  CHECK(cut.longest > 0.0);
  CHECK(cut.longest < 1e-3);
}
