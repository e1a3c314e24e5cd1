// Events by a hair, found by every method that locates events, at every tolerance: each slip at its time, none where there is
// none. Thousands are run by print_dips.cpp.
#include "mbd/model/method.h"
#include "tests/physics/dips.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <algorithm>
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
      const DipOutcome o =
          outcome(random_dip(hair, seed, dip_depth(hair, seed, m.has_fixed_step ? k_motion_of_fixed_steps : setting)), m.name, setting);
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

// Time stepping locates nothing, but halves a step that hides a slip: a peak of a load that is above what holds by less than a load
// bends by in a step. What it sticks with is the load's mean, whatever the step, so that nothing slips below. (Where a slip ends is
// known to the first order only, and with it whether another follows.)
TEST_CASE("time stepping slips where a peak between the ends of its steps is above what holds, and nowhere else") {
  int slips = 0, hidden = 0;
  for (const Hair hair : {Hair::friction, Hair::step_lap})
    for (int i = 0; i < k_cases; ++i) {
      const auto seed = static_cast<std::uint64_t>(i + 1);
      steplap::random::RandomNumber random(seed + 4444);
      const double share = random.decades(-2.0, -1.2); // of a period, which is 0.06 to 0.4 rad
      const double depth = random.decades(-5.0, -2.0) * (random.chance(0.3) ? -1.0 : 1.0);
      const DipCase dip = random_dip(hair, seed, depth);
      const Model model = scene(dip.text + "\n[simulation]\nstep = 1e-3\n");
      const auto system = compile(model);
      SimulationOptions options;
      options.end = options.output_step = dip.end;
      options.integrator = "moreau";
      options.settings.step = share * 2.0 * std::numbers::pi / dip.fastest;
      const RunResult result = simulate(*system, system->initial_state(), options);
      const auto first = std::find_if(result.events.begin(), result.events.end(),
                                      [&](const Event& e) { return e.element == dip.element && e.words().starts_with(dip.begins); });
      CAPTURE(seed);
      CAPTURE(share);
      CAPTURE(depth);
      CHECK((first != result.events.end()) == !dip.begin.empty());
      if (first == result.events.end() || dip.begin.empty()) continue;
      // It begins in this step, in the next one, whose mean is above what holds if its end is, or in a part of that.
      CHECK(std::abs(first->t - dip.begin.front()) <= 2.0 * options.settings.step);
      ++slips;
      if (depth < share * share) ++hidden; // a harmonic's top is flat to (2π share)²/8 of its size for a step
    }
  CHECK(slips >= k_cases);
  CHECK(hidden >= k_cases / 2);
}

// The same of a clamping pressure 1 − ½ (1 + cos) that falls below what a constant load asks for.
TEST_CASE("time stepping slips in a dip of the clamping pressure between the ends of its steps, and nowhere else") {
  for (int i = 0; i < k_cases; ++i) {
    steplap::random::RandomNumber random(static_cast<std::uint64_t>(i) + 5555);
    const double share = random.decades(-2.0, -1.2), depth = random.decades(-5.0, -2.0) * (random.chance(0.3) ? -1.0 : 1.0);
    const double phase = random.between(1.0, 2.0 * std::numbers::pi - 1.0);
    // 2000 N of pressure by a friction of 0.5 hold 1000 N, of which the least is 200 N.
    const std::string number = std::to_string(200.0 * (1.0 + depth));
    const std::string text =
        k_no_gravity + body("b", "mass = 10.0; inertia = 1.0") +
        signal_entry("harmonics", "press",
                     "offset = 0.6; amplitudes = [0.4]; frequencies = [1.0]; phases = [" + std::to_string(phase) + "]") +
        element("step_lap_joint", "held", "limb = 'b'; active_part = 'ground'; pressure_signal = 'press'") +
        element("step_lap_interface", "sheets",
                "joint = 'held'; yoke = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]; "
                "limb = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]; pressure = 1e5; static_friction = 0.5; kinetic_friction "
                "= 0.5") +
        signal_entry("constant", "s", "value = " + number) + element("load", "pull", "at = 'b'; force_x = 's'");
    const Model model = scene(text + "\n[simulation]\nstep = 1e-3\n");
    const auto system = compile(model);
    SimulationOptions options;
    options.end = options.output_step = 1.0; // the least once
    options.integrator = "moreau";
    options.settings.step = share;
    const RunResult result = simulate(*system, system->initial_state(), options);
    const bool has_slipped = std::any_of(result.events.begin(), result.events.end(),
                                         [](const Event& e) { return e.element == "held" && e.words().starts_with("slips"); });
    CAPTURE(i);
    CAPTURE(share);
    CAPTURE(depth);
    CAPTURE(phase);
    CHECK(has_slipped == (depth > 0.0));
  }
}

// The same pressure: the limb slides forward from where the load is more than what is left to hold it until it has come to rest, by
// nanometres and less, and friction never gives back what it took. The velocity with which that ends is known to what a slip's
// end is, grip over mass times a hundredth of the tolerance in seconds, or to a five-hundredth of the speed at which a slip counts
// as started; so much further it may go back.
TEST_CASE("a dip of the clamping pressure lets a joint slide forward, by as little as the closed form says") {
  constexpr double k_mass = 10.0, k_half = 400.0, k_omega = 2.0 * std::numbers::pi, k_grip = 1000.0 / k_mass; // kg, N, rad/s, m/s²
  for (const char* integrator : {"auto", "dop853", "tsit5", "rodas5p"})
    for (int i = 0; i < k_cases; ++i) {
      steplap::random::RandomNumber random(static_cast<std::uint64_t>(i) + 6666);
      const double depth = random.decades(-6.0, -2.0), phase = std::numbers::pi + random.either(0.3, 2.5),
                   tolerance = k_tolerances[static_cast<std::size_t>(i) % k_tolerances.size()];
      const double load = 200.0 * (1.0 + depth);
      char number[40];
      std::snprintf(number, sizeof number, "%.17g", load);
      const std::string text =
          k_no_gravity + body("b", "mass = 10.0; inertia = 1.0") +
          signal_entry("harmonics", "press",
                       "offset = 0.6; amplitudes = [0.4]; frequencies = [1.0]; phases = [" + std::to_string(phase) + "]") +
          element("step_lap_joint", "held", "limb = 'b'; active_part = 'ground'; pressure_signal = 'press'") +
          element("step_lap_interface", "sheets",
                  "joint = 'held'; yoke = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]; "
                  "limb = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]; pressure = 1e5; static_friction = 0.5; "
                  "kinetic_friction = 0.5") +
          signal_entry("constant", "s", std::string("value = ") + number) + element("load", "pull", "at = 'b'; force_x = 's'");
      CAPTURE(std::string(integrator));
      CAPTURE(i);
      CAPTURE(tolerance);
      CAPTURE(depth);
      const Run slid = run(scene(text + "\n[simulation]\nstep = 1e-3\n"), {integrator, tolerance, 1.0});
      // From −s to the instant τ about the least pressure: 200 N depth − 400 N (1 − cos ωτ) accelerates.
      const auto push = [&](double t) { return 200.0 * depth - 2.0 * k_half * std::pow(std::sin(0.5 * k_omega * t), 2); };
      const double start = -std::acos(1.0 - 200.0 * depth / k_half) / k_omega;
      double v = 0.0, x = 0.0, t = start, slowing = 0.0;
      const double h = -start / 4000.0;
      for (bool has_begun = false; !has_begun || v > 0.0; has_begun = true) { // midpoint rule
        x += h * (v + 0.5 * h * push(t + 0.5 * h) / k_mass);
        v += h * push(t + 0.5 * h) / k_mass;
        t += h;
        slowing = -push(t) / k_mass;
      }
      REQUIRE(slid.event_times("held", "slips").size() == 1);
      REQUIRE(slid.event_times("held", "sticks").size() == 1);
      const double end_time = std::clamp(1e-2 * tolerance, 1e-11, 1e-8),
                   onset_time = std::clamp(2.5e-4 * std::cbrt(tolerance), 5e-8, 2.5e-6);
      const double back = k_grip * std::max(end_time, 2e-3 * onset_time);
      const double known = 2.0 * back * back / (2.0 * slowing) + tolerance * 1e-3 * 0.32 + 1e-12; // beside what positions are known to
      CHECK(std::abs(slid.last("b.x") - x) < known + 1e-2 * x);
    }
}

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
