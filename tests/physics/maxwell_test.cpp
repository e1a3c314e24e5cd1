// The Maxwell element against closed forms: relaxation, harmonic response, free motion, and what a search for equilibrium makes of it.
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};
constexpr double k_stiffness = 2e4, k_damping = 1e4, k_time = k_damping / k_stiffness;
// A tolerance of 1e-11 a step over some hundred steps of decaying errors, relative to the largest value.
constexpr double k_close = 1e-9;

std::string mass(const std::string& fields) {
  return body("mass", "mass = 50; inertia = 1; " + fields) + element("prismatic", "guide", "a = 'mass'; axis = [1.0, 0.0]");
}
std::string maxwell(const std::string& more = "") {
  return element("maxwell", "pad", "a = 'mass'; axis = [1.0, 0.0]; stiffness = 1e4; damping = 5e3; count = 2" + more);
}
std::string driven(const std::string& signal) {
  return signal + element("prescribed_motion", "drive", "a = 'mass'; signal = 'way'; as = 'position'");
}

} // namespace

TEST_CASE("a preload relaxes by e in damping over stiffness") {
  const double preload = 300.0;
  const std::string text =
      mass("position = [0.0, 0.0]") + maxwell("; preload = 300.0") + driven(signal_entry("constant", "way", "value = 0.0"));
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 3.0 * k_time, 0.1 * k_time});
    const std::vector<double> force = r.series("pad.force");
    for (std::size_t i = 0; i < force.size(); ++i)
      CHECK(std::abs(force[i] - preload * std::exp(-r.times()[i] / k_time)) < k_close * preload);
    const double stored = 0.5 * preload * preload / k_stiffness;
    CHECK(r.result.statistics.dissipated == doctest::Approx(stored * (1.0 - std::exp(-6.0))).epsilon(1e-8));
  }
}

TEST_CASE("a harmonic elongation is answered by the complex stiffness, after a transient from rest") {
  const double way = 0.01, frequency = 0.7, omega = 2.0 * k_pi * frequency, turn = omega * k_time;
  // E = A iωτ/(1 + iωτ) is the amplitude of the stretch; from e = 0 the transient is −Re E e^(−t/τ).
  const double real = way * turn * turn / (1.0 + turn * turn), imaginary = way * turn / (1.0 + turn * turn);
  const std::string text =
      mass("position = [0.01, 0.0]") + maxwell() + driven(signal_entry("harmonics", "way", "amplitudes = [0.01]; frequencies = [0.7]"));
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 4.0, 0.05});
    const std::vector<double> force = r.series("pad.force");
    for (std::size_t i = 0; i < force.size(); ++i) {
      const double t = r.times()[i];
      const double stretch = real * (std::cos(omega * t) - std::exp(-t / k_time)) - imaginary * std::sin(omega * t);
      CHECK(std::abs(force[i] + k_stiffness * stretch) < k_close * k_stiffness * way);
    }
  }
}

// m ẍ = −k e, ė = ẋ − e/τ: the stretch is a damped oscillation, and the mass stops where the impulse c x of the damper is m v.
TEST_CASE("a mass that runs into a Maxwell element stops at m v over c, with all of its energy dissipated") {
  const double m = 50.0, v = 2.0;
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(mass("velocity = [2.0, 0.0]") + maxwell(), {method, 1e-11, 30.0, 0.05});
    const double decay = 0.5 / k_time, omega = std::sqrt(k_stiffness / m - decay * decay);
    const std::vector<double> stretch = r.series("pad.stretch");
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      const double t = r.times()[i];
      CHECK(std::abs(stretch[i] - v / omega * std::exp(-decay * t) * std::sin(omega * t)) < 10.0 * k_close * v / omega); // 95 swings
    }
    CHECK(r.last("mass.x") == doctest::Approx(m * v / k_damping).epsilon(1e-8));
    CHECK(r.result.statistics.dissipated == doctest::Approx(0.5 * m * v * v).epsilon(1e-8));
    CHECK(r.result.statistics.energy_residual < 1e-8);
  }
}

TEST_CASE("in equilibrium the spring beside it carries the weight, and nothing moves afterwards") {
  const std::string text = "gravity = [-10.0, 0.0]\n" + mass("") + maxwell() +
                           element("spring_damper", "spring", "a = 'mass'; axis = [1.0, 0.0]; stiffness = 1e5");
  Found found = settle(scene(text + k_head));
  CHECK(found.q(1, 0) == doctest::Approx(-50.0 * 10.0 / 1e5).epsilon(1e-9)); // forces of a rest are known to 1e-9
  Run r;
  r.system = std::move(found.system);
  r.result = simulate(*r.system, found.rest.state, options({"dop853", 1e-10, 2.0}));
  CHECK(r.last("mass.x") == doctest::Approx(-5e-3).epsilon(1e-8));
  CHECK(std::abs(r.last("pad.force")) < 1e-6 * 500.0);
}
