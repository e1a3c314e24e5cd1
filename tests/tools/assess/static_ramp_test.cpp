// Static proofs against slow runs: the vehicle's acceleration grows over many seconds, and events tell when something gives way.
#include "tests/tools/assess/static_scene.h"

#include "mbd/run/report.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace steplap;
using namespace steplap::assess;

namespace {

constexpr double k_seconds = 20.0;

// When the element first did so, as an acceleration; not-a-number if it never did.
double at_event(const Run& run, const std::string& element, const std::vector<EventKind>& kinds, double peak) {
  for (const Event& event : run.result.events)
    for (const EventKind kind : kinds)
      if (event.element == element && event.kind == kind) return event.t / k_seconds * peak;
  return std::nan("");
}

// The ascending half of a triangle: a vehicle that accelerates backward pulls forward.
Run slow_run(const std::string& file, std::vector<std::string> overrides, double peak) {
  for (const std::string& more : {std::string("signal.braking.kind=triangle"), "signal.braking.peak=" + std::to_string(-peak),
                                  "signal.braking.duration=" + std::to_string(2.0 * k_seconds), std::string("signal.braking.start=0"),
                                  "simulation.end=" + std::to_string(k_seconds), std::string("simulation.integrator=rodas5p"),
                                  std::string("simulation.tolerance=1e-8"), std::string("simulation.velocity=[0, 0]"),
                                  std::string("simulation.initial=equilibrium"), std::string("output.step=1")})
    overrides.push_back(more);
  return run_model(load_model(file, overrides));
}

// Both ways for one machine, forward and back.
void compare(const std::vector<std::string>& overrides, double peak, int& compared) {
  const std::string file = STEPLAP_MODELS "/paper/interference.toml";
  const auto loaded = load_model(file, overrides);
  StaticMachine machine(*loaded);
  for (const double sign : {1.0, -1.0}) {
    const StaticRay ray = grow_pull(machine, {sign, 0.0}, peak);
    const Run run = slow_run(file, overrides, sign * peak);
    REQUIRE_FALSE(run.failure);
    for (const StaticLimit& limit : ray.limits) {
      if (limit.kind == LimitKind::ends) continue;
      const double a = limit.kind == LimitKind::lifts
                           ? at_event(run, limit.element, {EventKind::opens}, peak)
                           : at_event(run, limit.element, {EventKind::slips_forward, EventKind::slips_backward}, peak);
      CAPTURE(sign);
      CAPTURE(limit.text);
      // Dampers hold back by c v: of a device of 2e8 N/m and 2e5 N s/m that is a millisecond, 5e-5 of the ramp; twice that for all
      // that the machine is made of.
      CHECK(std::abs(a / limit.acceleration - 1.0) <
            1e-4 + 1e-3 / k_seconds * peak / limit.acceleration + limit.error / limit.acceleration);
      ++compared;
      break; // beyond the first limit friction remembers the way, which a run with dampers goes a little otherwise
    }
    if (ray.limits.empty())
      for (const Event& event : run.result.events) CHECK_FALSE(is_slip(event.kind));
  }
}

} // namespace

TEST_CASE("the first limit is where a slow run has it: random machines") {
  std::mt19937 random(28); // its numbers are the same everywhere
  const auto between = [&random](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967295.0); };
  int compared = 0;
  for (int i = 0; i < 6; ++i) {
    const auto set = [](const std::string& path, double value) { return path + "=" + std::to_string(value); };
    const std::vector<std::string> overrides = {set("element.tank bottom.static_friction", between(0.15, 0.6)),
                                                set("element.bottom arresting.stiffness", between(3e7, 3e8)),
                                                set("element.top arresting.stiffness", between(3e7, 3e8)),
                                                set("element.tank flexibility.stiffness", between(2e7, 2e8)),
                                                set("body.active part.mass", between(30e3, 60e3)),
                                                set("element.front foot.stiffness", between(5e8, 3e9)),
                                                set("element.rear foot.stiffness", between(5e8, 3e9)),
                                                set("core.core.pressure", between(0.02e6, 0.06e6))};
    CAPTURE(i);
    compare(overrides, 12.0, compared);
  }
  CHECK(compared == 12); // something gave way in each: the comparison says something
}

// The limb is held by its joint alone, so that what slid before does not matter to it; dampers act between other bodies.
TEST_CASE("a joint slips where a slow run has it, after the floor has slid") {
  const std::string file = STEPLAP_MODELS "/paper/weak_clamping.toml";
  const double peak = 9.0;
  const auto loaded = load_model(file);
  StaticMachine machine(*loaded);
  const StaticRay ray = grow_pull(machine, {1.0, 0.0}, peak);
  const Run run = slow_run(file, {}, peak);
  REQUIRE_FALSE(run.failure);
  int compared = 0;
  for (const StaticLimit& limit : ray.limits) {
    if (limit.kind != LimitKind::slips) continue;
    CHECK(at_event(run, limit.element, {EventKind::slips}, peak) == doctest::Approx(limit.acceleration).epsilon(3e-6));
    ++compared;
  }
  CHECK(compared == 2);
}
