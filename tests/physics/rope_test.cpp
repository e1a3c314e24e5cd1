// Ropes: slack and taut, over pulleys, against closed forms.
#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/equilibrium.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

double channel(const System& system, const Equilibrium& rest, const std::string& name) {
  Dynamics dynamics(system);
  dynamics.set_state(rest.state);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(rest.state, y.data());
  dynamics.rates(0.0, y.data(), dy.data());
  return system.find_channel(name)->value(dynamics.snapshot(dy.data()));
}

} // namespace

// Let go with slack s the mass falls freely for √(2s/g), then stretches the rope by (m g/k)(1 + √(1 + 2 k s/(m g))), and
// comes back up to where it began.
TEST_CASE("a mass that falls into its rope is caught as the closed form says") {
  const double s = 0.5, k = 4000.0, m = 2.0;
  const std::string text =
      body("mass", "mass = 2; inertia = 0.1; position = [0.0, -1.0]") +
      element("rope", "line", "a = \"mass\"; b = { body = \"ground\", at = [0.0, 0.0] }; stiffness = 4000.0; slack = 0.5");
  for (const char* method : {"dop853", "rodas5p", "auto"}) {
    CAPTURE(std::string(method));
    const double stretch = m * k_g / k * (1.0 + std::sqrt(1.0 + 2.0 * k * s / (m * k_g)));
    const double omega = std::sqrt(k / m), v = std::sqrt(2.0 * k_g * s), sag = m * k_g / k;
    // From taut to the lowest point: x = sag + A sin(ω t − φ) with A cos φ = v/ω, A sin φ = sag.
    const double lowest = std::sqrt(2.0 * s / k_g) + (0.5 * 3.14159265358979323846 + std::atan2(sag, v / omega)) / omega;
    const Run r = run(text, {method, 1e-10, lowest});
    const std::vector<double> taut = r.event_times("line", "closes its gap");
    REQUIRE(taut.size() == 1);
    CHECK(std::abs(taut[0] - std::sqrt(2.0 * s / k_g)) < 1e-8);
    CHECK(std::abs(r.last("mass.y") + 1.0 + s + stretch) < 1e-8); // tolerance 1e-10 over some hundred steps
    CHECK(std::abs(r.last("line.tension") - k * stretch) < k * 1e-7);
    CHECK(r.result.statistics.energy_residual < 1e-7);
    const Run up = run(text, {method, 1e-10, 2.0 * lowest});
    CHECK(std::abs(up.last("mass.y") + 1.0) < 1e-6);
    CHECK(up.last("line.tension") == 0.0);
  }
}

// A block and tackle: the rope runs from the ceiling over the load's pulley up over the ceiling's and down to a weight.
// 2 T = M g and T = m g: it rests if M = 2 m only, with the rope stretched by T/k.
TEST_CASE("over two pulleys a weight holds twice its own, and the tension is the same all along") {
  const auto tackle = [](const std::string& mass) {
    return scene("[simulation]\nstep = 1e-3\n[[marker]]\nname = \"sheave\"\nbody = \"load\"\npoint = [0.0, 0.0]\n"
                 "[[marker]]\nname = \"block\"\nbody = \"ground\"\npoint = [0.0, 0.0]\n" +
                 body("load", "mass = 40; inertia = 1; position = [0.0, -2.0]") +
                 body("weight", "mass = " + mass + "; inertia = 1; position = [1.0, -1.0]") +
                 element("point_on_line", "left guide", "a = \"load\"; axis = [0.0, 1.0]") +
                 element("point_on_line", "right guide", "a = \"weight\"; b = { body = \"ground\", at = [1.0, 0.0] }; axis = [0.0, 1.0]") +
                 element("spring_damper", "peg",
                         "a = \"weight\"; b = { body = \"ground\", at = [1.0, -1.0] }; axis = [0.0, 1.0]; "
                         "stiffness = 100.0; free_length = 0.0") +
                 element("rope", "rope",
                         "a = { body = \"ground\", at = [0.0, 0.0] }; b = \"weight\"; "
                         "over = [\"sheave\", \"block\", \"turn\"]; stiffness = 1e5") +
                 "[[marker]]\nname = \"turn\"\nbody = \"ground\"\npoint = [1.0, 0.0]\n");
  };
  for (const double mass : {20.0, 21.0}) {
    CAPTURE(mass);
    const auto system = compile(tackle(std::to_string(mass)));
    const Equilibrium rest = find_equilibrium(*system, system->initial_state());
    // 2 T = 40 g; the weight sinks until the peg has the difference: 100 N/m · δ = (m − 20) g.
    CHECK(std::abs(channel(*system, rest, "rope.tension") - 20.0 * k_g) < 1e-8);
    const double down = (mass - 20.0) * k_g / 100.0, stretch = 20.0 * k_g / 1e5;
    CHECK(std::abs(rest.state.q[7] + 1.0 + down) < 1e-10);
    CHECK(std::abs(rest.state.q[4] + 2.0 - 0.5 * (down - stretch)) < 1e-10);
  }
}

TEST_CASE("a rope does not push: a boom above its anchor falls as if it were not there") {
  const std::string text = "[simulation]\nstep = 1e-3\n" + body("boom", "mass = 10; inertia = 1; position = [-0.1, 1.0]") +
                           element("revolute", "foot", "a = { body = \"boom\", at = [0.0, 0.0] }") +
                           element("rope", "stay", "a = \"boom\"; b = { body = \"ground\", at = [0.0, -2.0] }; stiffness = 1e5");
  const auto system = compile(scene(text));
  const Equilibrium rest = find_equilibrium(*system, system->initial_state());
  CHECK(channel(*system, rest, "stay.tension") == 0.0);
  CHECK(std::abs(rest.state.q[3]) < 1e-9);
  CHECK(rest.state.q[4] < -1.0);
}

TEST_CASE("pretension is there in the reference pose, and faults are told") {
  const std::string lid = "[simulation]\nstep = 1e-3\n" + body("lid", "mass = 10; inertia = 1; position = [0.0, 1.0]");
  const auto system = compile(scene(lid + element("rope", "lashing", "a = \"lid\"; stiffness = 1e5; pretension = 300.0")));
  Equilibrium given;
  given.state = system->initial_state();
  given.state.mode.assign(given.state.mode.size(), 1);
  CHECK(std::abs(channel(*system, given, "lashing.tension") - 300.0) < 1e-9);
  const auto fails = [&](const std::string& fields) {
    CHECK_THROWS_AS((void)compile(scene(lid + element("rope", "lashing", fields))), ModelError);
  };
  fails("a = \"lid\"; stiffness = 1e5; pretension = 300.0; slack = 0.1");
  fails("a = \"lid\"; stiffness = 1e5; pretension = 3e5");
  fails("a = \"lid\"; b = { body = \"lid\", point = [1.0, 0.0] }; stiffness = 1e5");
  fails("a = \"lid\"; stiffness = 1e5; over = [\"nowhere\"]");
}

// Ropes from a mass to both sides of the plane: 2 T l/L = m g with the height l and the length L = √(l² + c²) of each.
TEST_CASE("a mass hangs from a pair of ropes that leave the plane as statics in space says") {
  const double m = 30.0, k = 5000.0, c = 0.6, l_0 = 0.9; // L₀ is the length in the reference pose
  const auto system = compile(scene("[simulation]\nstep = 1e-3\n" + body("mass", "mass = 30; inertia = 1; position = [0.0, -0.9]") +
                                    element("rope", "pair", "a = \"mass\"; b = \"ground\"; stiffness = 5000.0; across = 0.6; count = 2")));
  const Equilibrium rest = find_equilibrium(*system, system->initial_state());
  const double l = -rest.state.q[4], length = std::hypot(l, c);
  const double tension = k * (length - std::hypot(l_0, c));
  CHECK(std::abs(2.0 * tension * l / length - m * k_g) < 1e-7); // the search for rest leaves 1e-9 of the weight
  CHECK(std::abs(channel(*system, rest, "pair.tension") - tension) < 1e-9 * k);
  CHECK(std::abs(channel(*system, rest, "pair.length") - length) < 1e-12);
}

// EN 12195-1, direct lashing: T = m g (c_x − μ)/(2 (cos α cos β + μ sin α)) while the load slides, with the angle α to the deck and β of the
// chain's projection to the direction of travel.
TEST_CASE("two chains in space carry what the standard demands") {
  const double m = 25e3, mu = 0.4 * 0.75, half = std::sqrt(0.5), root = std::sqrt(3.0);
  const double demanded = m * k_g * (0.8 - mu) / (2.0 * (half * root / 2.0 + mu * half));
  CHECK(std::abs(demanded - 74.36e3) < 5.0); // as the number is printed
  // A chain of 2 m with α = 45° and β = 30°: √2 high, √2 cos β along, √2 sin β across.
  const std::string text =
      body("load", "mass = 25000; inertia = 5e4; position = [0.0, 0.5]") +
      element("polygon_contact", "deck", "a = \"load\"; stiffness = 1e10; dissipation = 1.0; static_friction = 0.3") +
      element("rope", "chains",
              "a = { body = \"load\", at = [0.0, 1.4142135623730951] }; b = { body = \"ground\", at = [-1.2247448713915890, 0.0] }; "
              "across = 0.70710678118654752; count = 2; stiffness = 1e9; damping = 1e6") +
      "[[signal]]\nname = \"braking\"\nkind = \"trapezoid\"\npeak = " + std::to_string(0.8 * m * k_g) +
      "\nduration = 5.0\nrise = 2.0\nfall = 2.0\n" +
      element("load", "braking", "at = { body = \"load\", at = [0.0, 0.0] }; force_x = \"braking\"");
  std::string outlined = text;
  outlined.replace(outlined.find("position = [0.0, 0.5]"), 21,
                   "position = [0.0, 0.5]\noutline = [[-2.0, -0.5], [2.0, -0.5], [2.0, 1.0], [-2.0, 1.0]]");
  const Run r = run(outlined, {"auto", 1e-9, 2.0}); // to the end of the rise: friction is at its bound while the load slides
  // The chains stretch by 0.1 mm of 2 m, which turns them by 1e-4; vibration from the onset of slip has decayed.
  CHECK(std::abs(r.last("chains.tension") / demanded - 1.0) < 1e-3);
}

// EN 12195-1, lashing over the top: friction holds c_x m g ≤ μ (c_z m g + n k F_T sin α), F_T at the tensioner, (k − 1) F_T on the far side.
// Solved for the number of straps this is n = (c_x − μ c_z) m g/(k μ sin α F_T), times its safety factor.
TEST_CASE("straps over the top hold what the standard says, with k = 1.5 and other factors") {
  const double m = 2e3, mu = 0.3, preload = 5e3, height = 1.0, rise = 2.0;
  for (const auto& [k, across, count] : {std::tuple(1.5, 0.0, 2L), std::tuple(1.5, 0.57735026918962576, 3L), std::tuple(2.0, 0.2, 1L)}) {
    const double sine = height / std::hypot(height, across), held = mu * (m * k_g + static_cast<double>(count) * k * preload * sine);
    const auto side = [&](const std::string& name, double pretension) {
      return element("rope", name,
                     "a = { body = \"load\", at = [0.0, 1.0] }; b = \"ground\"; stiffness = 1e4; across = " + std::to_string(across) +
                         "; count = " + std::to_string(count) + "; pretension = " + std::to_string(pretension));
    };
    const double peak = 1.02 * held;
    const std::string text =
        body("load", "mass = 2000; inertia = 400; position = [0.0, 0.5]; outline = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]]") +
        element("polygon_contact", "deck", "a = \"load\"; stiffness = 1e10; dissipation = 1.0; static_friction = 0.3") +
        side("tensioner side", preload) + side("far side", (k - 1.0) * preload) +
        "[[signal]]\nname = \"push\"\nkind = \"trapezoid\"\npeak = " + std::to_string(peak) + "\nduration = 5.0\nrise = 2.0\nfall = 2.0\n" +
        element("load", "push", "at = { body = \"load\", at = [0.0, 0.0] }; force_x = \"push\"");
    Run r;
    r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
    r.result = simulate(*r.system, find_equilibrium(*r.system, r.system->initial_state()).state, options({"auto", 1e-9, rise}));
    const std::vector<double> slips = r.event_times("deck", "slips forward");
    REQUIRE(!slips.empty());
    // The load sinks by some µm, which takes 0.1 N from the straps, and the push shakes it a little on the stiff deck.
    CHECK(std::abs(peak * slips.front() / rise / held - 1.0) < 1e-3);
  }
}
