// A ladder leans on a wall whose friction is enormous, or stands on a floor on which it jams: friction that changes the
// normal force it hangs on by more than itself.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_mass = 20.0, k_length = 4.0, k_stiffness = 1e7, k_damping = 2e3, k_pi = 3.14159265358979323846;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string end_text(const std::string& name, double x, double y, const std::string& normal, double friction) {
  return element("unilateral_contact", name,
                 "a = { body = 'ladder', point = [" + number(x) + ", " + number(y) + "] }; b = 'ground'; gap = 0.0; normal = " + normal +
                     "; stiffness = " + number(k_stiffness) + "; damping = " + number(k_damping)) +
         element("coulomb_stick", name + " friction", "contacts = ['" + name + "']; static_friction = " + number(friction));
}

// Both ends just touch; `speed`: of the whole ladder, away from the wall.
std::string ladder(double degrees, double at_wall, double at_floor, double speed = 0.0) {
  const double angle = degrees * k_pi / 180.0, x = 0.5 * k_length * std::cos(angle), y = 0.5 * k_length * std::sin(angle);
  std::string text = "gravity = [0.0, -9.81]\n" +
                     body("ladder", "mass = 20.0; inertia = " + number(k_mass * k_length * k_length / 12.0) + "; position = [" + number(x) +
                                        ", " + number(y) + "]; velocity = [" + number(speed) + ", 0.0]") +
                     end_text("foot", x, -y, "[0.0, 1.0]", at_floor) + end_text("top", -x, y, "[1.0, 0.0]", at_wall);
  std::replace(text.begin(), text.end(), '\'', '"');
  return text;
}

// Let go at rest with a friction μ → ∞ at the wall, the top slides down with a normal force of nothing: what presses it,
// N, and its friction, μN = S, must keep the top's end at the wall, and since friction turns the ladder away from it S is
// what balances the couple of the foot's force F about the centre: S = F, both ends lift alike, the ladder sinks without
// turning, m y'' = 2F − m g, F = −k y − c y', and needs no friction at its foot. It sticks where it comes to rest, half a
// period later.
struct Sinking {
  double rate = std::sqrt(2.0 * k_stiffness / k_mass), share = k_damping / (k_mass * rate);
  double half = k_pi / (rate * std::sqrt(1.0 - share * share));
  double depth = k_mass * 9.81 / (2.0 * k_stiffness) * (1.0 + std::exp(-share * k_pi / std::sqrt(1.0 - share * share)));
};

} // namespace

TEST_CASE("a wall with a friction of 1e6 carries half of a ladder that sinks onto its foot") {
  const Sinking exact;
  for (const double degrees : {30.0, 60.0, 80.0})
    for (const char* method : {"auto", "rodas5p", "dop853", "tsit5"})
      for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
        const bool is_dear = std::string(method) == "dop853" || std::string(method) == "tsit5";
        if (is_dear && (degrees != 60.0 || tolerance == 1e-6)) continue; // the scene is stiff: 1e6 evaluations
        CAPTURE(degrees);
        CAPTURE(method);
        CAPTURE(tolerance);
        const Run r = run(ladder(degrees, 1e6, 0.3), {method, tolerance, 0.01});
        const std::vector<double> sticks = r.event_times("top friction", "sticks");
        REQUIRE_FALSE(sticks.empty());
        // Tolerances are of displacements of a thousandth of the radius of gyration, 1.2 mm. The closed form leaves out
        // 1/μ and the microsecond in which the top first touches: some 1e-5. Where `auto` steps through a storm of events
        // at the start, steps of 10 µs of the first order leave ω h = 1e-2 of the depth.
        const double depth = std::abs(r.last("top friction.slide_rear"));
        const double storm = std::string(method) == "auto" ? 1e-2 : 0.0;
        const double known = 1.2e-3 * tolerance + (2e-5 + storm) * exact.depth;
        CHECK(std::abs(depth - exact.depth) < known);
        // The weight does so much more or less work; and a hundredth, as a run that is to be trusted.
        CHECK(r.result.statistics.energy_residual < k_mass * 9.81 * (known + 1e-2 * exact.depth));
        CHECK(r.result.statistics.events < 5000); // 1e5 stop a run, as a contact that rattled did at 1e-3
      }
}

TEST_CASE("time stepping follows the ladder at the wall, at first order") {
  const Sinking exact;
  double last = 0.0;
  for (const double step : {1e-4, 1e-5}) {
    Run r;
    r.system = compile(scene(ladder(60.0, 1e6, 0.3) + "\n[simulation]\nstep = 1e-3\n"));
    SimulationOptions o = options({"moreau", 1.0, 0.02, 0.0});
    o.settings.step = step;
    r.result = simulate(*r.system, r.system->initial_state(), o);
    const double error = std::abs(std::abs(r.last("top friction.slide_rear")) - exact.depth) / exact.depth;
    CHECK(error < exact.rate * step); // ω h: implicit Euler over half a period is off by about π/4 of it
    if (last > 0.0) CHECK(error < 0.2 * last);
    last = error;
  }
}

TEST_CASE("a ladder that slides out on a floor of friction 2 to 10 jams, and all methods agree") {
  // The foot's friction presses it into the floor from μ = (J/m + x²)/(x y) = 1.35 on (Painlevé): the normal force grows
  // by itself until the foot sticks. Nothing is chaotic within 0.1 s: methods differ by their errors alone.
  for (const double friction : {2.0, 5.0, 10.0}) {
    CAPTURE(friction);
    const std::string text = ladder(60.0, 0.3, friction, 1.0);
    const Run exact = run(text, {"dop853", 1e-12, 0.1});
    for (const char* method : {"auto", "tsit5", "rodas5p"}) {
      CAPTURE(method);
      const Run r = run(text, {method, 1e-8, 0.1});
      for (const char* channel : {"ladder.x", "ladder.y", "ladder.theta"}) // 1e-8 a step over some 1e3 steps, of 0.1 m
        CHECK(std::abs(r.last(channel) - exact.last(channel)) < 1e-6);
      CHECK(r.result.statistics.evaluations < 50000); // none of it is stiff
    }
  }
}
