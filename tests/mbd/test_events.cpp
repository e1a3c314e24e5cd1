// The event finder on motions whose events are known: grazing, two crossings inside one step, several
// at once.
#include "mbd/events/event_finder.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// Thrown upward with 5 m/s at t = 0: its apex is v²/(2g) high at v/g. A soft ceiling `depth` below the apex.
std::string thrown(double depth) {
  const double apex = 25.0 / (2.0 * 9.81);
  return R"(
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
velocity = [0.0, 5.0]
[[element]]
kind = "unilateral_contact"
name = "ceiling"
a = "ball"
b = { body = "ground", at = [0.0, )" +
         number(apex - depth) + R"(] }
normal = [0.0, -1.0]
stiffness = 10.0
)";
}

const std::vector<Settings> k_methods = {{"rk4", 0.1, 1.0}, {"rk4", 0.017, 1.0}, {"tsit5", 1e-10, 1.0}, {"dop853", 1e-10, 1.0}};

} // namespace

TEST_CASE("events: in and out within one step, however briefly") {
  for (const Settings& settings : k_methods)
    for (const double depth : {1e-2, 1e-4, 1e-6, 1e-9}) {
      CAPTURE(settings.integrator);
      CAPTURE(settings.step_or_tolerance);
      CAPTURE(depth);
      const Run r = run(thrown(depth), settings);
      const std::vector<double> closes = r.event_times("ceiling", "closes"), opens = r.event_times("ceiling", "opens");
      const double inside = std::sqrt(2.0 * depth / 9.81), apex = 5.0 / 9.81, speed = 9.81 * inside;
      REQUIRE(closes.size() == 1);
      REQUIRE(opens.size() == 1);
      // The depth is a difference of lengths of 1 m: some roundings of it over the speed.
      CHECK(std::abs(closes[0] - (apex - inside)) < 3e-14 / speed + 1e-13);
      // Inside, the contact delays the apex by a share k·depth/(m g) of the time spent there.
      CHECK(std::abs(opens[0] - (apex + inside)) < 0.02 * inside + 3e-14 / speed);
    }
}

TEST_CASE("events: a miss by a hair is no event") {
  for (const Settings& settings : k_methods)
    for (const double depth : {-1e-12, -1e-9, -1e-4}) {
      CAPTURE(depth);
      CHECK(run(thrown(depth), settings).result.events.empty());
    }
}

TEST_CASE("events: two feet that land at once both close, and what lands flat stays flat") {
  // One body on two feet; and two bodies on a foot each, joined by a pin, so that projection moves the
  // pose at the event by rounding.
  const std::string one = R"(
[[body]]
name = "table"
mass = 4.0
inertia = 1.0
position = [0.0, 1.0]
)";
  const std::string two = R"(
[[body]]
name = "table"
mass = 2.0
inertia = 0.5
position = [-0.3, 1.0]
[[body]]
name = "leaf"
mass = 2.0
inertia = 0.5
position = [0.3, 1.0]
[[element]]
kind = "weld"
name = "glue"
a = { body = "table", at = [0.1, 0.9] }
b = "leaf"
)";
  const auto feet = [](const std::string& right) {
    return "[[element]]\nkind = \"unilateral_contact\"\nname = \"left\"\na = { body = \"table\", at = [-0.7, 0.8] }\nstiffness = "
           "2e4\ndamping = 40.0\n"
           "[[element]]\nkind = \"unilateral_contact\"\nname = \"right\"\na = { body = \"" +
           right + "\", at = [0.7, 0.8] }\nstiffness = 2e4\ndamping = 40.0\n";
  };
  for (const std::string& text : {one + feet("table"), two + feet("leaf")})
    for (const Settings& settings : {Settings{"rk4", 1e-3, 3.0}, Settings{"dop853", 1e-10, 3.0}, Settings{"tsit5", 1e-10, 3.0}}) {
      CAPTURE(settings.integrator);
      const Run r = run(text, settings);
      const std::vector<double> left = r.event_times("left"), right = r.event_times("right");
      CHECK(std::abs(left.at(0) - std::sqrt(2.0 * 0.8 / 9.81)) < 1e-13);
      REQUIRE(left.size() == right.size());
      // Each landing amplifies a difference between the feet by no more than ten.
      for (std::size_t i = 0; i < std::min<std::size_t>(left.size(), 6); ++i) CHECK(std::abs(left[i] - right[i]) < 1e-10);
      CHECK(std::abs(r.last("table.theta")) < 1e-9);
      CHECK(r.last("left.force") == doctest::Approx(r.last("right.force")).epsilon(1e-6));
    }
}

TEST_CASE("events: many that fall together, with joints between them") {
  // Ten balls in a row, joined by rods, land on a floor at the same instant.
  std::string text;
  for (int i = 0; i < 10; ++i) {
    const std::string name = "ball " + std::to_string(i);
    text += "[[body]]\nname = \"" + name + "\"\nmass = 1.0\ninertia = 0.1\nposition = [" + std::to_string(i) + ".0, 0.7]\n";
    text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor " + std::to_string(i) + "\"\na = \"" + name +
            "\"\nstiffness = 1e4\ndamping = 30.0\n";
    if (i > 0)
      text += "[[element]]\nkind = \"distance\"\nname = \"rod " + std::to_string(i) + "\"\na = \"" + name + "\"\nb = \"ball " +
              std::to_string(i - 1) + "\"\n";
  }
  for (const Settings& settings : {Settings{"rk4", 1e-3, 1.0, 0.05}, Settings{"dop853", 1e-10, 1.0, 0.05}}) {
    CAPTURE(settings.integrator);
    const Run r = run(text, settings);
    for (int i = 0; i < 10; ++i) {
      const std::vector<double> closes = r.event_times("floor " + std::to_string(i), "closes");
      REQUIRE(!closes.empty());
      CHECK(std::abs(closes[0] - std::sqrt(2.0 * 0.7 / 9.81)) < 1e-12);
      const std::vector<double> y = r.series("ball " + std::to_string(i) + ".y"), first = r.series("ball 0.y");
      for (std::size_t k = 0; k < y.size(); ++k) CHECK(std::abs(y[k] - first[k]) < 1e-9);
    }
  }
}

TEST_CASE("events: friction starts and lands on the foot that the pose asks for") {
  const auto tilted = [](double angle, double height) {
    return R"(
[[body]]
name = "box"
mass = 1.0
inertia = 0.2
position = [0.0, )" +
           number(height) + R"(]
angle = )" +
           number(angle) + R"(
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "box", point = [-0.5, -0.5] }
stiffness = 1e4
damping = 50.0
[[element]]
kind = "unilateral_contact"
name = "front"
a = { body = "box", point = [0.5, -0.5] }
stiffness = 1e4
damping = 50.0
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["front", "rear"]
static_friction = 0.5
)";
  };
  // The rear-most foot while θ ≥ 0, the front-most otherwise; pressed from the start, or after a fall.
  for (const double height : {0.49, 0.6}) {
    const double end = height < 0.5 ? 1e-4 : std::sqrt(2.0 * 0.1 / 9.81) + 1e-3;
    CHECK(run(tilted(-0.002, height), {"rk4", 1e-4, end}).result.final_state.friction[0].foot == 1);
    CHECK(run(tilted(0.002, height), {"rk4", 1e-4, end}).result.final_state.friction[0].foot == 0);
  }
}

TEST_CASE("events: a gap that rounding left negative at the start of a step still closes") {
  const auto system = compile(scene(R"(
[simulation]
step = 1e-3
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
velocity = [0.0, -1.0]
[[element]]
kind = "unilateral_contact"
name = "floor"
a = "ball"
stiffness = 1e4
)"));
  State state = system->initial_state();
  state.q[4] = -1e-15; // y of the ball, the contact open
  Dynamics dynamics(*system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  const auto integrator = make_integrator("rk4", dynamics, options({"rk4", 1e-3, 1.0}).settings);
  integrator->restart(dynamics, 0.0, y.data());
  integrator->step(dynamics, 1.0);
  EventFinder finder(*system, dynamics.dimension());
  CHECK(finder.find(*integrator, dynamics, std::vector<char>(system->event_count, 0)));
  CHECK(finder.theta() < 1e-3); // at once
  CHECK(finder.fired() == std::vector<int>{0});
}

TEST_CASE("a root is estimated from values and slopes, to the remainder of the polynomial through them") {
  RootEstimate estimate;
  estimate.add(3.0, std::sin(3.0), std::cos(3.0));
  estimate.add(3.3, std::sin(3.3), std::cos(3.3));
  const double first = estimate.root(3.0, 3.3, 1e-17);
  // f/4! (x − 3)² (x − 3.3)² over the slope at the root, with |f| ≤ 0.16 and slopes beyond 0.98
  CHECK(std::abs(first - std::numbers::pi) < 3.5e-6);
  CHECK(std::abs(first - std::numbers::pi) > 1e-9); // the next line shows something
  estimate.add(first, std::sin(first), std::cos(first));
  // the next remainder has the square of the first estimate's error in it: rounding of numbers near 4
  CHECK(std::abs(estimate.root(3.0, 3.3, 1e-17) - std::numbers::pi) < 1e-15);

  estimate.clear();
  for (const double x : {0.0, 0.2, 0.7, 1.0}) estimate.add(x, (0.4 - x) * (x * x + 1.0));
  CHECK(std::abs(estimate.root(0.2, 0.7, 1e-17) - 0.4) < 1e-15); // a cubic through four places
}

TEST_CASE("a crossing is closed in on to rounding by a handful of looks") {
  const auto system = compile(scene(R"(
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
position = [0.0, 1.0]
[[element]]
kind = "unilateral_contact"
name = "floor"
a = "ball"
stiffness = 1e4
)"));
  const State state = system->initial_state();
  Dynamics dynamics(*system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  const auto integrator = make_integrator("rk4", dynamics, options({"rk4", 0.6, 1.0}).settings);
  integrator->restart(dynamics, 0.0, y.data());
  integrator->step(dynamics, 1.0);
  const long before = dynamics.evaluations();
  EventFinder finder(*system, dynamics.dimension());
  REQUIRE(finder.find(*integrator, dynamics, std::vector<char>(system->event_count, 0)));
  const double t = integrator->t0() + finder.theta() * integrator->h();
  CHECK(std::abs(t - std::sqrt(2.0 / 9.81)) < 1e-14); // of rounding in y over the velocity, 2e-16/4.4, and of t
  CHECK(dynamics.evaluations() - before <= 6);
}

// A contact that touches and does not move has the value zero at every look. Each of 100 steps takes 4 stages and the 6 looks of
// one survey; before, such steps were divided to the last part allowed, 4800 evaluations each.
TEST_CASE("events: what touches without being pressed costs a look, not a search") {
  const Run r = run(R"(
[[body]]
name = "pendulum"
mass = 1.0
inertia = 0.1
position = [1.0, 0.0]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "pendulum", at = [0.0, 0.0] }
[[body]]
name = "still"
mass = 1.0
inertia = 0.1
position = [0.0, 5.0]
[[element]]
kind = "weld"
name = "hold"
a = "still"
[[element]]
kind = "unilateral_contact"
name = "touch"
a = "still"
b = { body = "ground", at = [0.0, 5.0] }
stiffness = 1e6
gap = 0.0
)",
                    {"rk4", 0.01, 1.0});
  CHECK(r.result.statistics.steps == 100);
  CHECK(r.result.statistics.evaluations < 15 * r.result.statistics.steps);
  CHECK(r.result.events.empty());
}
