// Small vibrations: closed forms, and a run that starts along a mode's shape.
#include "mbd/equilibrium.h"
#include "mbd/modes.h"
#include "tests/physics/paper_runs.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

VibrationModes modes_of(const std::string& text) {
  const auto system = compile(parse_model(text, "scene.toml", transformer_catalog()));
  return vibration_modes(*system, find_equilibrium(*system, system->initial_state()).state);
}

const char* k_guided_mass = R"(
[simulation]
step = 1e-3
[[body]]
name = "mass"
mass = 4.0
inertia = 1.0
position = [0.0, 0.0]
[[element]]
kind = "prismatic"
name = "guide"
a = "mass"
axis = [0.0, 1.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [0.0, 1.0]
stiffness = 400.0
)";

} // namespace

TEST_CASE("a mass on a spring and damper vibrates as the textbook says") {
  const VibrationModes found = modes_of(std::string(k_guided_mass) + "damping = 8.0\n");
  REQUIRE(found.modes.size() == 1);
  CHECK(found.rigid_motions == 0);
  const double omega = std::sqrt(400.0 / 4.0), zeta = 8.0 / (2.0 * 4.0 * omega);
  // One exact Jacobian and a 2 × 2 eigenproblem: rounding.
  CHECK(std::abs(found.modes[0].natural_frequency() - omega / (2.0 * std::numbers::pi)) < 1e-13);
  CHECK(std::abs(found.modes[0].damping_ratio() - zeta) < 1e-14);
  CHECK(std::abs(found.modes[0].shape[4] - 1.0) < 1e-14); // y of body 1
}

TEST_CASE("an overdamped mass has two real decays, a free one a rigid motion") {
  const VibrationModes slow = modes_of(std::string(k_guided_mass) + "damping = 200.0\n");
  REQUIRE(slow.modes.size() == 2);
  const double root = std::sqrt(25.0 * 25.0 - 100.0); // c/2m = 25 /s
  CHECK(std::abs(slow.modes[0].eigenvalue - (-25.0 + root)) < 1e-12);
  CHECK(std::abs(slow.modes[1].eigenvalue - (-25.0 - root)) < 1e-12);
  const VibrationModes free = modes_of("gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n[[body]]\nname = \"mass\"\nmass = 4.0\ninertia = 1.0\n");
  CHECK(free.modes.empty());
  CHECK(free.rigid_motions == 3);
}

TEST_CASE("a compound pendulum about its pin") {
  const VibrationModes found = modes_of(R"(
[simulation]
step = 1e-3
[[body]]
name = "rod"
mass = 3.0
inertia = 0.25
position = [0.0, -0.5]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "rod", at = [0.0, 0.0] }
b = { body = "ground", at = [0.0, 0.0] }
)");
  REQUIRE(found.modes.size() == 1);
  const double omega = std::sqrt(3.0 * 9.81 * 0.5 / (0.25 + 3.0 * 0.25));
  CHECK(std::abs(found.modes[0].natural_frequency() * 2.0 * std::numbers::pi / omega - 1.0) < 1e-12);
  CHECK(std::abs(found.modes[0].damping_ratio()) < 1e-12);
}

TEST_CASE("the paper's transformer, nudged along a mode, follows its eigenvalue") {
  Model model = paper_model(Condition::no_interference);
  model.simulation.velocity.setZero();
  const auto system = compile(model);
  State rest = find_equilibrium(*system, system->initial_state()).state;
  const VibrationModes found = vibration_modes(*system, rest);
  // 12 coordinates move freely in the reference; 7 are held by friction that sticks: 5 vibrate.
  int coordinates = 0;
  for (const VibrationMode& mode : found.modes) coordinates += mode.oscillates() ? 2 : 1;
  CHECK(coordinates == 2 * 5);
  CHECK(found.rigid_motions == 0);
  for (const VibrationMode& mode : found.modes) {
    CAPTURE(mode.natural_frequency());
    CHECK(mode.eigenvalue.real() < 0.0); // every motion is damped
    if (!mode.oscillates()) continue;
    // Small against the feet's depth (0.2 mm), large against the rounding of metres.
    constexpr double k_nudge = 1e-8;
    State nudged = rest;
    for (std::size_t i = 3; i < nudged.q.size(); ++i) {
      nudged.q[i] += k_nudge * mode.shape[i].real();
      nudged.v[i] = k_nudge * (mode.eigenvalue * mode.shape[i]).real();
    }
    SimulationOptions o = options({"dop853", 1e-11, 0.02}); // before the pulse begins
    o.output_step = 0.0;
    const RunResult run = simulate(*system, nudged, o);
    const std::complex<double> factor = std::exp(mode.eigenvalue * 0.02);
    double worst = 0.0;
    for (std::size_t i = 3; i < nudged.q.size(); ++i) {
      const double expected = (factor * mode.shape[i]).real();
      worst = std::max(worst, std::abs((run.final_state.q[i] - rest.q[i]) / k_nudge - expected));
    }
    // Rest is found to 1e-15 m, a ten-millionth of the nudge; what is not linear is of the order of the
    // nudge over the geometry's millimetres.
    CHECK(worst < 1e-4);
  }
}
