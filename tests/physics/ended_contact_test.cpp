// Faces that end: what runs past an end is not carried on, and no energy is made.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

std::string law_text(const std::string& law) {
  if (law == "hunt_crossley") return "law = \"hunt_crossley\"; exponent = 1.5; stiffness = 1e8; preload = 981.0; ";
  return "law = \"" + law + "\"; stiffness = 1e6; preload = 981.0; ";
}

// Guided, so that it does not turn: it slides along x at 2 m/s, from 0.3 m before the end of its face.
std::string slider(const std::string& law) {
  return body("block", "mass = 100; inertia = 1; position = [0.7, 0.0]; velocity = [2.0, 0.0]") +
         element("prescribed_motion", "upright", "a = \"block\"; coordinate = \"angle\"; signal = \"still\"") +
         signal_entry("constant", "still", "value = 0.0") +
         element("unilateral_contact", "foot", law_text(law) + "a = \"block\"; b = \"ground\"; ends = [-1.0, 1.0]");
}

} // namespace

TEST_CASE("a foot that runs past the end of its face falls from there, its strain lost and no energy made") {
  for (const std::string law : {"kelvin_voigt", "literal", "hunt_crossley"})
    for (const char* method : {"dop853", "rodas5p", "auto"}) {
      CAPTURE(law);
      CAPTURE(std::string(method));
      const Run r = run(slider(law), {method, 1e-9, 0.45});
      const std::vector<double> off = r.event_times("foot", "opens");
      REQUIRE(off.size() == 1);
      CHECK(std::abs(off[0] - 0.15) < 1e-9); // 0.3 m at 2 m/s; an event is located to rounding, the motion to 1e-9
      CHECK(std::abs(r.last("block.vy") + k_g * 0.3) < 1e-7);
      CHECK(std::abs(r.last("block.y") + 0.5 * k_g * 0.09) < 1e-7);
      CHECK(r.last("foot.force") == 0.0);
      CHECK(r.last("foot.along") == doctest::Approx(1.6));
      // δ = F/k, ½ k δ² = F²/(2 k); k δ^1.5 = F, 2/5 k δ^2.5 = 2/5 F δ.
      const double strain = law == "hunt_crossley" ? 0.4 * 981.0 * std::pow(981.0 / 1e8, 2.0 / 3.0) : 981.0 * 981.0 / 2e6;
      CHECK(r.result.final_state.dissipated == doctest::Approx(strain).epsilon(1e-6));
      CHECK(r.result.statistics.energy_residual < 1e-6);
    }
}

TEST_CASE("what comes from beside the face is not lifted onto it; from above it is caught between the ends only") {
  const auto drop = [](double x, double vx) {
    return body("ball",
                "mass = 1; inertia = 1; position = [" + std::to_string(x) + ", 0.2]; velocity = [" + std::to_string(vx) + ", 0.0]") +
           element("unilateral_contact", "face", "a = \"ball\"; stiffness = 1e5; damping = 100.0; ends = [-1.0, 1.0]");
  };
  const Settings settings{"dop853", 1e-9, 1.0};
  const Run caught = run(drop(0.9, 0.0), settings), beside = run(drop(1.1, 0.0), settings), under = run(drop(1.3, -1.0), settings);
  CHECK(caught.last("ball.y") > -1e-2);
  for (const Run* r : {&beside, &under}) {
    CHECK(r->last("ball.y") == doctest::Approx(0.2 - 0.5 * k_g));
    CHECK(r->result.events.empty());                           // that it is off is no event
    CHECK(r->result.statistics.energy_residual < 1e-9 * 10.0); // m g h = 10 J
    CHECK(r->result.final_state.dissipated < 1e-20);           // what rounding of a projection books
  }
}

TEST_CASE("a plank on two feet, one of which runs off, tips over the other") {
  const std::string text =
      body("plank", "mass = 20; inertia = 2.0; position = [0.0, 0.1]; velocity = [1.0, 0.0]") +
      element("unilateral_contact", "front",
              "a = { body = \"plank\", point = [0.5, -0.1] }; stiffness = 1e6; damping = 1e3; preload = 98.1; ends = [-3.0, 0.6]") +
      element("unilateral_contact", "rear",
              "a = { body = \"plank\", point = [-0.5, -0.1] }; stiffness = 1e6; damping = 1e3; preload = 98.1; ends = [-3.0, 0.6]") +
      element("coulomb_stick", "soles", "contacts = [\"front\", \"rear\"]; static_friction = 0.01");
  const Run r = run(text, {"auto", 1e-8, 0.4});
  REQUIRE(r.event_times("front", "opens").size() == 1);
  CHECK(r.last("plank.theta") < -0.05);
  CHECK(r.result.statistics.energy_residual < 1e-6 * r.result.statistics.energy_exchanged);
}

TEST_CASE("friction leaves a foot that has run off: what slides on is braked at the foot that is left") {
  // The foot in the air turns back while the other one still runs on. Friction at the wrong one would push it along.
  const auto foot = [](const std::string& name, const std::string& x) {
    return element("unilateral_contact", name,
                   "a = { body = \"box\", point = [" + x +
                       ", -0.3] }; stiffness = 1e8; damping = 1e5; preload = 490.5; ends = [-5.0, 1.0]");
  };
  const std::string text = body("box", "mass = 100; inertia = 10; position = [0.0, 0.3]; velocity = [2.0, 0.0]") + foot("rear", "-0.4") +
                           foot("front", "0.4") +
                           element("coulomb_stick", "soles", "contacts = [\"rear\", \"front\"]; static_friction = 0.2");
  const Run r = run(text, {"auto", 1e-8, 0.7, 1e-3});
  REQUIRE(r.event_times("front", "opens").size() == 1);
  CHECK(r.event_times("soles") == std::vector<double>{0.0}); // it slides forward from the start, and that is all
  const std::vector<double> friction = r.series("soles.friction"), rear = r.series("rear.force"), rate = r.series("soles.slip_rate");
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    CHECK(rate[i] > 0.0);
    if (r.times()[i] > r.event_times("front", "opens")[0]) CHECK(friction[i] == doctest::Approx(-0.2 * rear[i]).epsilon(1e-12));
  }
}

TEST_CASE("ends in the wrong order are refused") {
  CHECK_THROWS_AS(
      run(body("ball", "mass = 1; inertia = 1") + element("unilateral_contact", "f", "a = \"ball\"; stiffness = 1e5; ends = [1.0, -1.0]"),
          {"dop853", 1e-6, 0.1}),
      ModelError);
}
