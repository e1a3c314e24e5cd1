// Signals that are made of others, in runs: as loads and as drives.
#include "elements/catalog.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;

namespace {

const std::string k_block = R"(gravity = [0.0, 0.0]
[simulation]
end = 1.0
integrator = "dop853"
tolerance = 1e-11
[output]
step = 0.01
[[body]]
name = "block"
mass = 2.0
inertia = 1.0
[[element]]
kind = "spring_damper"
name = "spring"
a = "block"
b = "ground"
stiffness = 300.0
axis = [1.0, 0.0]
[[signal]]
kind = "haversine"
name = "pulse"
peak = 40.0
start = 0.1
duration = 0.3
[[signal]]
kind = "rectangle"
name = "step"
peak = -25.0
start = 0.25
duration = 0.4
[[signal]]
kind = "harmonics"
name = "wave"
amplitudes = [3.0]
frequencies = [5.0]
phases = ["-90 deg"]
)";

RunResult run(const std::string& text) {
  const Model model = parse_model(text, "scene.toml", element_catalog());
  const auto system = compile(model);
  return simulate(*system, system->initial_state(), options_of(model));
}

std::string load(const std::string& name, const std::string& signal) {
  return "[[element]]\nkind = \"load\"\nname = \"" + name + "\"\nat = \"block\"\nforce_x = \"" + signal + "\"\n";
}

} // namespace

TEST_CASE("a load that is the sum of two signals moves a body as two loads do") {
  const RunResult two = run(k_block + load("first", "pulse") + load("second", "step"));
  const RunResult one =
      run(k_block + load("both", "whole") + "[[signal]]\nkind = \"sum\"\nname = \"whole\"\nsignals = [\"pulse\", \"step\"]\n");
  // The same breakpoints, and the same loads to rounding.
  CHECK(std::abs(two.final_state.q[3] - one.final_state.q[3]) < 1e-13);
  CHECK(std::abs(two.final_state.v[3] - one.final_state.v[3]) < 1e-12);
  CHECK(std::abs(two.final_state.q[3]) > 1e-4); // it has moved
  CHECK(one.statistics.steps == two.statistics.steps);
}

// A drive at the level of acceleration takes both integrals of the product: of 40 (½ − ½ cos Ωτ) sin ωt these are
// those of three harmonics.
TEST_CASE("a body driven by a product keeps to its integrals") {
  const std::string drive = "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"block\"\n"
                            "coordinate = \"x\"\nsignal = \"burst\"\nas = \"acceleration\"\n"
                            "[[signal]]\nkind = \"product\"\nname = \"burst\"\nsignals = [\"pulse\", \"late wave\"]\n"
                            "[[signal]]\nkind = \"scaled\"\nname = \"late wave\"\nsignal = \"wave\"\n"
                            "factor = 2.0\ndelay = 0.1\n";
  const RunResult driven = run(k_block + drive);
  // From 0.1 s to 0.4 s: 40 (½ − ½ cos Ωτ) · 6 sin ωτ with Ω = 2π/0.3 and ω = 10π; its terms are 120 sin ωτ
  // − 60 sin((ω+Ω)τ) − 60 sin((ω−Ω)τ), of which each has the velocity A (1 − cos wτ)/w and the way
  // A (τ/w − sin(wτ)/w²).
  const double pi = std::acos(-1.0), big = 2.0 * pi / 0.3, w = 10.0 * pi, tau = 0.3;
  double velocity = 0.0, way = 0.0;
  for (const auto& [amplitude, f] : {std::pair(120.0, w), std::pair(-60.0, w + big), std::pair(-60.0, w - big)}) {
    velocity += amplitude * (1.0 - std::cos(f * tau)) / f;
    way += amplitude * (tau / f - std::sin(f * tau) / (f * f));
  }
  way += velocity * 0.6; // and on without acceleration
  CHECK(std::abs(driven.final_state.v[3] - velocity) < 1e-12);
  CHECK(std::abs(driven.final_state.q[3] - way) < 1e-12);
}

TEST_CASE("a drive whose velocity would jump is refused where a sum of signals makes it") {
  const std::string drive = "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"block\"\n"
                            "coordinate = \"x\"\nsignal = \"whole\"\nas = \"velocity\"\n"
                            "[[signal]]\nkind = \"sum\"\nname = \"whole\"\nsignals = [\"pulse\", \"step\"]\n";
  CHECK_THROWS_AS(static_cast<void>(run(k_block + drive)), ModelError);
}

// x'' + 2 D ω x' + ω² x = F/m: x(t) = ∫ e^{−Dω(t−s)} sin(ω_d (t−s)) F(s) ds / (m ω_d), by Gauss' rule on parts within which neither turns by
// more than 0.1 rad.
TEST_CASE("a damped oscillator answers a chirp as Duhamel's integral says, through its resonance") {
  const double m = 2.0, k = 300.0, c = 3.0, omega = std::sqrt(k / m), decay = 0.5 * c / m,
               damped = std::sqrt(omega * omega - decay * decay);
  const double pi = std::acos(-1.0), from = 0.3, to = 6.0, end = 1.0;
  for (const bool is_exponential : {false, true})
    for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
      CAPTURE(is_exponential);
      CAPTURE(std::string(method));
      std::string text = k_block + load("shaker", "sweep") +
                         "[[signal]]\nkind = \"chirp\"\nname = \"sweep\"\namplitude = 40.0\nfrom = 0.3\nto = 6.0\n" +
                         "duration = 1.0\ncourse = \"" + (is_exponential ? "exponential" : "linear") + "\"\nphase = 0.4\n";
      text.replace(text.find("stiffness = 300.0"), 17, "stiffness = 300.0\ndamping = 3.0");
      text.replace(text.find("dop853"), 6, method);
      const RunResult found = run(text);
      const auto force = [&](double s) {
        const double growth = std::log(to / from) / end;
        const double turns = is_exponential ? from * std::expm1(growth * s) / growth : from * s + 0.5 * (to - from) / end * s * s;
        return 40.0 * std::sin(2.0 * pi * turns + 0.4);
      };
      double x = 0.0;
      const int parts = 800;
      for (int i = 0; i < parts; ++i)
        for (const double place : {0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)}) {
          const double s = end * (i + place) / parts, weight = place == 0.5 ? 4.0 / 9.0 : 5.0 / 18.0;
          x += weight * end / parts * std::exp(-decay * (end - s)) * std::sin(damped * (end - s)) * force(s) / (m * damped);
        }
      CHECK(std::abs(x) > 1e-3);
      CHECK(std::abs(found.final_state.q[3] - x) < 1e-10); // a tolerance of 1e-11 a step
    }
}
