// Bearing friction that follows the reaction, μ r R: what holds, when a pulley starts, and how long a rotor coasts.
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};
constexpr double k_radius = 0.05;

std::string journal(const std::string& body, const std::string& friction) {
  return element("bearing", "journal",
                 "a = { body = '" + body + "', at = [0.0, 0.0] }; stiffness = 1e8; damping = 2e5; radius = 0.05; " + friction);
}

Run run_from_rest(const std::string& text, const Settings& settings) {
  Found found = settle(text);
  Run r;
  r.system = std::move(found.system);
  r.result = simulate(*r.system, found.rest.state, options(settings));
  return r;
}

} // namespace

// At rest the reaction is the weight, whatever the angle: m g l sin θ ≤ μ r m g.
TEST_CASE("a pendulum on a journal rests wherever the friction circle reaches its vertical") {
  const double length = 0.5, friction = 0.2, bound = friction * k_radius / length;
  const auto pendulum = [&](double sine) {
    return body("bob", "mass = 10; inertia = 0.4; angle = " + number(std::asin(sine)) +
                           "; position = " + point(length * sine, -length * std::sqrt(1.0 - sine * sine))) +
           journal("bob", "static_friction = 0.2");
  };
  for (const double share : {-0.999, 0.5, 0.999}) {
    CAPTURE(share);
    const Run r = run_from_rest(pendulum(share * bound), {"dop853", 1e-10, 2.0});
    CHECK(r.last("journal.mode") == 1.0);
    CHECK(std::abs(r.last("journal.slip_rate")) < 1e-15); // rounding of a constraint
    CHECK(r.last("bob.theta") == doctest::Approx(std::asin(share * bound)).epsilon(1e-9));
    CHECK(r.last("journal.share") == doctest::Approx(std::abs(share)).epsilon(1e-6)); // it has sunk by 1 µm of half a metre
  }
  // Beyond the circle it swings, and ends within it.
  const Run r = run(pendulum(4.0 * bound), {"dop853", 1e-9, 20.0});
  CHECK(r.last("journal.mode") == 1.0);
  CHECK(std::abs(std::sin(r.last("bob.theta"))) < bound);
  CHECK(r.event_times("journal", "slips backward").size() >= 1); // the bob hangs to the right
}

// Weights w₁ = w + s t and w₂ = w at the rim, and the pulley's own: (w₁ − w₂) ρ = μ r (w₁ + w₂ + M g).
TEST_CASE("a pulley starts when the difference of its weights exceeds the bound, whichever is the heavier one") {
  const double rim = 0.3, friction = 0.15, mass = 20.0, weight = 1000.0, rate = 50.0, moment = friction * k_radius;
  const double expected = moment * (2.0 * weight + mass * k_g) / (rate * (rim - moment));
  for (const char* method : k_methods)
    for (const double side : {-1.0, 1.0}) {
      CAPTURE(method);
      CAPTURE(side);
      const auto hung = [&](const char* name, double x, const std::string& more) {
        return element("load", name, "at = { body = 'pulley', point = " + point(x, 0.0) + " }; force = [0.0, -1000.0]" + more);
      };
      const std::string text =
          body("pulley", "mass = 20; inertia = 0.9") + journal("pulley", "static_friction = 0.15; kinetic_friction = 0.1") +
          hung("first", side * rim, "") + hung("second", -side * rim, "") +
          signal_entry("trapezoid", "growth", "peak = -5000.0; rise = 100.0; duration = 300.0; fall = 100.0") +
          element("load", "growing", "at = { body = 'pulley', point = " + point(side * rim, 0.0) + " }; force_y = 'growth'");
      const Run r = run_from_rest(text, {method, 1e-10, 1.2 * expected});
      const std::vector<double> starts = r.event_times("journal", side > 0.0 ? "slips backward" : "slips forward");
      REQUIRE(starts.size() == 1);
      // The growing weight makes the pulley sink with s/k = 5e-7 m/s, against a damper of 2e5 N s/m that is a part of the reaction; the
      // swinging that it begins with has decayed.
      CHECK(starts[0] == doctest::Approx(expected).epsilon(1e-6));
      CHECK(r.last("pulley.omega") * side < 0.0);
    }
}

// The reaction of a balanced rotor is its weight, so it loses ω at the constant rate μ_k r m g/J.
TEST_CASE("a rotor coasts for J ω over the couple of friction") {
  const double inertia = 4.0, speed = 30.0, mass = 80.0, couple = 0.1 * k_radius * mass * k_g;
  for (const char* method : k_methods) {
    CAPTURE(method);
    Found found = settle(body("rotor", "mass = 80; inertia = 4") + journal("rotor", "static_friction = 0.2; kinetic_friction = 0.1"));
    State start = found.rest.state;
    start.v[5] = speed;
    const Run r{std::move(found.system), {}};
    const RunResult result = simulate(*r.system, start, options({method, 1e-11, 40.0, 1.0}));
    const std::vector<double> omega = result.trajectory->series("rotor.omega");
    // The weight is carried to 1e-9, the accuracy of a rest.
    for (std::size_t i = 0; i < omega.size(); ++i) {
      const double t = result.trajectory->times()[i];
      CHECK(std::abs(omega[i] - std::max(0.0, speed - couple / inertia * t)) < 1e-7 * speed);
    }
    CHECK(result.statistics.dissipated == doctest::Approx(0.5 * inertia * speed * speed).epsilon(1e-7));
  }
}

TEST_CASE("impossible bearings are refused") {
  const auto refused = [](const std::string& fields) {
    try {
      (void)compile(scene(k_head + body("rotor", "mass = 1; inertia = 1") + journal("rotor", fields)));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused("static_friction = 0.1; kinetic_friction = 0.2").find("must not exceed") != std::string::npos);
  CHECK(refused("static_friction = 0.1; b = 'rotor'").find("itself") != std::string::npos);
  CHECK(refused("").find("needs 'static_friction'") != std::string::npos);
}
