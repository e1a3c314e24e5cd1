// Events by a hair, found by every method that locates events, at every tolerance: each slip at its time, none where there is
// none. Thousands are run by print_dips.cpp.
#include "mbd/model/method.h"
#include "tests/physics/dips.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr int k_cases = 54; // of each kind and method: a multiple of the tolerances and the steps
const std::vector<double> k_tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11};
// Shares of the fastest period. Those of what moves are such that the motion is known as dip_depth() is told.
const std::vector<double> k_steps_of_loads = {0.2, 0.05, 0.02}, k_steps_of_motions = {0.02, 0.01, 0.005};
constexpr double k_motion_of_fixed_steps = 1e-5;

void check_all(Hair hair) {
  const bool moves = hair == Hair::gap || hair == Hair::rope;
  for (const Method& m : methods()) {
    if (m.is_time_stepping) continue;
    const std::vector<double>& settings = !m.has_fixed_step ? k_tolerances : moves ? k_steps_of_motions : k_steps_of_loads;
    int events = 0;
    for (int i = 0; i < k_cases; ++i) {
      const auto seed = static_cast<std::uint64_t>(i + 1);
      const double setting = settings[static_cast<std::size_t>(i) % settings.size()];
      const DipOutcome o = outcome(random_dip(hair, seed, dip_depth(hair, seed, m.has_fixed_step ? k_motion_of_fixed_steps : setting)), m.name, setting);
      CAPTURE(std::string(m.name));
      CAPTURE(seed);
      CAPTURE(setting);
      CHECK(o.failure == "");
      CHECK(o.found == o.wanted);
      CHECK(o.worst <= 1.0);
      events += o.wanted;
    }
    CHECK(events >= k_cases / 2);
  }
}

} // namespace

TEST_CASE("a block slips wherever a load's peak is above what friction holds by a hair, and nowhere else") { check_all(Hair::friction); }

TEST_CASE("a step-lap joint slips wherever a load's peak is above its capacity by a hair, and nowhere else") { check_all(Hair::step_lap); }

TEST_CASE("a gap closes by a hair") { check_all(Hair::gap); }

TEST_CASE("a rope becomes taut by a hair") { check_all(Hair::rope); }

// 30 N + 10 N cos(2π t + 2.13) on 39.9996 N: it slips where the cosine is 0.99996, before t = 1 − 2.13/2π.
TEST_CASE("a peak of a hundred-thousandth above what holds, between the places of every step") {
  const double slips = 1.0 - (2.13 + std::acos(0.99996)) / (2.0 * std::numbers::pi);
  const Model model = read_model(std::string(STEPLAP_TEST_DATA) + "/load_above_friction_by_a_hair.toml", transformer_catalog());
  for (const char* integrator : {"auto", "dop853", "tsit5", "rodas5p"})
    for (const double tolerance : k_tolerances) {
      CAPTURE(std::string(integrator));
      CAPTURE(tolerance);
      const std::vector<double> times = run(model, {integrator, tolerance, 1.0}).event_times("f", "slips forward");
      REQUIRE(times.size() == 1);
      CHECK(std::abs(times[0] - slips) < 1e-6 * tolerance + 1e-11); // 1e-13 of 40 N over 0.56 N/s
    }
}
