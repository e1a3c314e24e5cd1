// Skates: what runs along one of its own directions only. Motions here are closed forms: a knife edge on an incline, Chaplygin's sleigh,
// a vehicle on a circle; and what is conserved.
#include "tests/physics/model_text.h"
#include "tests/physics/stepped.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <tuple>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};
// What an integration at 1e-12 leaves of metres after some seconds.
constexpr double k_close = 1e-9;

// --- a knife edge on an incline, turning: its cusped path is a cycloid (e.g. A. M. Bloch, Nonholonomic Mechanics and Control, 1.6)

constexpr double k_downhill = 3.0, k_spin = 2.0; // m/s² along x, rad/s
const std::string k_knife =
    "gravity = [3.0, 0.0]\n" + body("knife", "mass = 2; inertia = 0.3; angular_velocity = 2.0") + element("skate", "edge", "a = 'knife'");

Vec2 cycloid(double t) {
  const double turned = k_spin * t, size = k_downhill / (2.0 * k_spin * k_spin);
  return {size * std::sin(turned) * std::sin(turned), size * (turned - 0.5 * std::sin(2.0 * turned))};
}

double miss_of_cycloid(const Run& r) { return (Vec2(r.last("knife.x"), r.last("knife.y")) - cycloid(r.times().back())).norm(); }

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

} // namespace

TEST_CASE("a knife edge that turns on an incline writes a cycloid and does not slide down") {
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(k_knife, {method, 1e-12, 7.0, 0.05});
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      const double t = r.times()[i];
      CHECK((Vec2(r.series("knife.x")[i], r.series("knife.y")[i]) - cycloid(t)).norm() < k_close);
      // Of the centre's acceleration v ω across the edge and of the weight's part there: twice the same.
      CHECK(std::abs(r.series("edge.force")[i] - 2.0 * 2.0 * k_downhill * std::sin(k_spin * t)) < 10.0 * k_close);
      CHECK(std::abs(r.series("edge.speed")[i] - k_downhill / k_spin * std::sin(k_spin * t)) < k_close);
    }
    CHECK(r.result.statistics.energy_residual < 1e-9); // of 4.5 J
  }
}

TEST_CASE("skates converge with the order of the method") {
  double before = 0.0;
  for (const double step : {0.04, 0.02, 0.01}) {
    const double miss = miss_of_cycloid(run(k_knife, {"rk4", step, 4.0}));
    // The next term of the error is a power of the step smaller: 2⁴ within a tenth.
    if (before > 0.0) CHECK(before / miss == doctest::Approx(16.0).epsilon(0.1));
    before = miss;
  }
  before = 0.0;
  for (const double step : {4e-3, 2e-3, 1e-3}) {
    const double miss = miss_of_cycloid(stepped(k_knife, step, 4.0));
    if (before > 0.0) CHECK(before / miss >= 1.9); // of the first order at least
    before = miss;
  }
}

TEST_CASE("Chaplygin's sleigh turns until it runs straight, its weight ahead of its edge") {
  // With u the speed of the edge, k² = J/m + d²: u' = d ω², k² ω' = −d u ω; so u² + k² ω² stays what it was.
  const double mass = 2.0, inertia = 0.4, ahead = 0.3, spin = 1.5, k = std::sqrt(inertia / mass + ahead * ahead);
  const std::string sleigh =
      k_no_gravity + body("sleigh", "mass = 2; inertia = 0.4; angular_velocity = 1.5; velocity = [0.0, " + number(spin * ahead) + "]") +
      element("skate", "edge", "a = { body = 'sleigh', point = [-0.3, 0.0] }");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(sleigh, {method, 1e-12, 5.0, 0.1});
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      const double x = ahead * spin * r.times()[i] / k;
      CHECK(std::abs(r.series("edge.speed")[i] - k * spin * std::tanh(x)) < k_close);
      CHECK(std::abs(r.series("sleigh.omega")[i] - spin / std::cosh(x)) < k_close);
    }
  }
}

TEST_CASE("an edge on a raft that floats: nothing from outside, so momenta and energy stay") {
  const std::string text =
      k_no_gravity + body("raft", "mass = 5; inertia = 2; angular_velocity = 0.4; velocity = [0.3, -0.1]") +
      body("rider", "mass = 2; inertia = 0.3; position = [0.5, 0.2]; angle = 0.7; angular_velocity = -1.1; velocity = [0.5, 0.9]") +
      element("skate", "edge", "a = { body = 'rider', point = [0.1, -0.2], angle = 0.3 }; b = 'raft'; axis = [0.8, 0.6]") +
      element("spring_damper", "elastic", "a = 'rider'; b = { body = 'raft', point = [1.0, 0.5] }; stiffness = 20");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-12, 6.0, 0.2});
    const auto of = [&](const char* body, const char* what, std::size_t i) { return r.series(std::string(body) + "." + what)[i]; };
    const auto momenta = [&](std::size_t i) {
      Vec3 sum = Vec3::Zero();
      for (const auto& [name, mass, inertia] : {std::tuple{"raft", 5.0, 2.0}, std::tuple{"rider", 2.0, 0.3}}) {
        const double vx = of(name, "vx", i), vy = of(name, "vy", i);
        sum += Vec3(mass * vx, mass * vy, inertia * of(name, "omega", i) + mass * (of(name, "x", i) * vy - of(name, "y", i) * vx));
      }
      return sum;
    };
    for (std::size_t i = 1; i < r.times().size(); ++i) CHECK((momenta(i) - momenta(0)).norm() < k_close);
    CHECK(r.result.statistics.energy_residual < 1e-9);
    CHECK(std::abs(r.last("raft.omega") - r.series("raft.omega")[0]) > 0.01); // the edge does press on the raft
  }
}

TEST_CASE("a vehicle whose front axle is turned by δ drives on a circle of radius L / tan δ") {
  const double rear = 1.2, base = 2.6, steer = 0.2, speed = 5.0, radius = base / std::tan(steer), spin = speed / radius;
  const std::string car =
      k_no_gravity +
      body("car", "mass = 900; inertia = 1300; angular_velocity = " + number(spin) + "; velocity = [5.0, " + number(spin * rear) + "]") +
      element("skate", "rear axle", "a = { body = 'car', point = [-1.2, 0.0] }") +
      element("skate", "front axle", "a = { body = 'car', point = [1.4, 0.0], angle = 0.2 }");
  const Run r = run(car, {"dop853", 1e-12, 10.0, 0.5});
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    const double turned = spin * r.times()[i];
    const Vec2 axle(-rear + radius * std::sin(turned), radius * (1.0 - std::cos(turned)));
    const Vec2 centre = axle + rear * Vec2(std::cos(turned), std::sin(turned));
    CHECK((Vec2(r.series("car.x")[i], r.series("car.y")[i]) - centre).norm() < 10.0 * k_close); // over 50 m
    CHECK(std::abs(r.series("rear axle.speed")[i] - speed) < k_close);
    CHECK(std::abs(r.series("front axle.speed")[i] - speed / std::cos(steer)) < k_close);
    // Across the car: the centre of gravity goes round at its distance; moments about it cancel.
    const double across = r.series("rear axle.force")[i] + r.series("front axle.force")[i] * std::cos(steer);
    CHECK(across == doctest::Approx(900.0 * spin * spin * radius).epsilon(1e-9));
    CHECK(1.4 * std::cos(steer) * r.series("front axle.force")[i] == doctest::Approx(rear * r.series("rear axle.force")[i]).epsilon(1e-9));
  }
}

TEST_CASE("a skate with a grip slides sideways against it, and holds when it has come to rest") {
  // Across: 2 m/s against 4 N on 2 kg. Along: nothing.
  const std::string block =
      k_no_gravity + body("block", "mass = 2; inertia = 1; velocity = [3.0, 2.0]") + element("skate", "edge", "a = 'block'; grip = 4.0");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(block, {method, 1e-12, 2.0, 0.25});
    const std::vector<double> rests = r.event_times("edge", "sticks");
    REQUIRE(rests.size() == 1);
    CHECK(std::abs(rests[0] - 1.0) < k_close);
    CHECK(std::abs(r.last("block.y") - 1.0) < k_close);
    CHECK(std::abs(r.last("block.x") - 6.0) < k_close);
    CHECK(std::abs(r.last("block.vy")) < 1e-12);
    CHECK(std::abs(r.result.statistics.dissipated - 4.0) < k_close);
  }
  const Run r = stepped(block, 1e-3, 2.0);
  CHECK(std::abs(r.last("block.y") - 1.0) < 2e-3); // a step of 2 m/s
  CHECK(std::abs(r.last("block.vy")) < 1e-12);
}

TEST_CASE("a skate slips where its grip is reached, and drags less") {
  const double grip = 6.0, drags = 5.0, mass = 2.0, growth = 10.0, slips = grip / growth, end = 1.0;
  const std::string pushed = k_no_gravity + body("block", "mass = 2; inertia = 1") +
                             element("skate", "edge", "a = 'block'; grip = 6.0; drags = 5.0") +
                             element("force", "push", "a = 'block'; coordinate = 'y'; formula = \"'10 N/s' * t\"");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(pushed, {method, 1e-12, end});
    const std::vector<double> found = r.event_times("edge", "slips forward");
    REQUIRE(found.size() == 1);
    CHECK(std::abs(found[0] - slips) < k_close);
    const double tau = end - slips; // y'' = (growth t − drags)/mass from rest
    CHECK(std::abs(r.last("block.y") - (growth * tau * tau * tau / 6.0 + (grip - drags) * tau * tau / 2.0) / mass) < k_close);
    CHECK(r.last("edge.force") == doctest::Approx(-drags));
    CHECK(r.last("edge.mode") == 2.0);
  }
}

TEST_CASE("skates in joint coordinates move as in absolute ones") {
  // The knee moves with 0.4 m/s, and the edge, 0.9 m behind it, not at all across the arm.
  const double knee = 0.5 * 0.8, turns = -knee / 0.9;
  const std::string train =
      "gravity = [0.4, -0.3]\n" + body("post", "mass = 3; inertia = 0.5; angular_velocity = 0.8") +
      body("arm", "mass = 1.5; inertia = 0.2; position = [1.0, 0.0]; velocity = [0.0, " + number(knee + 0.5 * turns) +
                      "]; angular_velocity = " + number(turns)) +
      element("revolute", "pivot", "a = { body = 'post', point = [0.0, 0.0] }") +
      element("revolute", "knee", "a = { body = 'arm', point = [-0.5, 0.0] }; b = { body = 'post', point = [0.5, 0.0] }") +
      element("skate", "edge", "a = { body = 'arm', point = [0.4, 0.0] }");
  const Model model = scene(train + "\n[simulation]\nstep = 1e-3\n");
  Run runs[2];
  for (const bool is_joint : {false, true}) {
    SimulationOptions o = options({"dop853", 1e-12, 3.0, 0.1});
    o.coordinates = is_joint ? Coordinates::joint : Coordinates::absolute;
    Run& r = runs[is_joint ? 1 : 0];
    r.system = compile(model);
    r.result = simulate(*r.system, r.system->initial_state(), o);
  }
  for (const char* channel : {"arm.x", "arm.y", "arm.theta", "post.theta", "edge.force", "edge.speed"})
    for (std::size_t i = 0; i < runs[0].times().size(); ++i) {
      CAPTURE(channel);
      CHECK(std::abs(runs[0].series(channel)[i] - runs[1].series(channel)[i]) < k_close);
    }
}

TEST_CASE("what a skate cannot be is said") {
  const auto refused = [](const std::string& fields, const std::string& words) {
    CAPTURE(fields);
    try {
      (void)compile(scene(body("block", "mass = 2; inertia = 1") + element("skate", "edge", fields) + "[simulation]\nstep = 1e-3\n"));
      FAIL("accepted");
    } catch (const ModelError& error) {
      CHECK(std::string(error.what()).find(words) != std::string::npos);
    }
  };
  refused("a = 'block'; axis = [0.0, 0.0]", "'axis' has no direction");
  refused("a = 'block'; drags = 2.0", "give 'grip', too");
  refused("a = 'block'; drags = 2.0; grip = 1.0", "'drags' must not exceed 'grip'");
  refused("a = 'block'; b = 'block'", "runs on its own body");
  refused("a = 'block'; grip = 0.0", "grip");
  refused("a = 'block'; grip = '3 kg'", "grip");
}
