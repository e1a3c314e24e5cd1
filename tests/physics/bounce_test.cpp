// A mass dropped on a unilateral contact: every flight and every contact is a closed form, so the events
// of a published case (1 kg from 1 m, k = 1e5, c = 20) are known to all digits.
#include "elements/contact_laws.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string dropped(const std::string& law) {
  return R"(
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
position = [0.0, 1.0]
[[element]]
kind = "unilateral_contact"
name = "floor"
a = "ball"
stiffness = 1e5
)" + law;
}

} // namespace

TEST_CASE("a bouncing mass whose contact never pulls") {
  for (const Settings& settings :
       {Settings{"dop853", 1e-12, 10.0, 5.0}, Settings{"tsit5", 1e-12, 10.0, 5.0}, Settings{"rk4", 1e-4, 10.0, 5.0}}) {
    CAPTURE(settings.integrator);
    const Run r = run(dropped("damping = 20.0\n"), settings);
    const std::vector<double> closes = r.event_times("floor", "closes"), leaves = r.event_times("floor", "force reaches zero");
    REQUIRE(closes.size() == 43);
    // An error at one contact grows with the number of bounces after it, about forty times in all.
    const double tolerance = settings.integrator == "rk4" ? 2e-9 : 1e-11;
    CHECK(std::abs(closes[0] - 0.451523640985731) < 1e-13); // free fall is exact for every method
    CHECK(std::abs(leaves[0] - 0.461309647824878) < tolerance);
    CHECK(std::abs(closes[1] - 1.27998531039192) < 10.0 * tolerance);
    CHECK(std::abs(r.series("ball.y")[1] - 0.173031311957123) < 100.0 * tolerance);
    CHECK(std::abs(r.series("ball.vy")[1] - 0.803729314210234) < 1000.0 * tolerance);
    CHECK(std::abs(closes.back() - 9.3013309499589) < 1000.0 * tolerance); // it rests from here on
    CHECK(std::abs(r.last("ball.y") + 9.81e-5) < 1e-5);                    // at rest, the contact compressed by its weight
    CHECK(leaves.size() == 42);                                            // the last contact never ends
    const RunStatistics& s = r.result.statistics;
    CHECK(s.energy_residual < (settings.integrator == "rk4" ? 1e-7 : 1e-10) * s.energy_exchanged);
  }
}

TEST_CASE("a bouncing mass with the paper's literal law, whose damper may pull") {
  const Run r = run(dropped("damping = 20.0\nlaw = \"literal\"\n"), {"dop853", 1e-12, 10.0, 5.0});
  CHECK(r.event_times("floor", "closes").size() == 42);
  CHECK(std::abs(r.series("ball.y")[1] - 0.188436942866305) < 1e-9);
  CHECK(std::abs(r.series("ball.vy")[1] - 0.464316535567175) < 1e-8);
}

TEST_CASE("without damping it bounces for ever to the same height") {
  for (const char* law : {"", "law = \"literal\"\n", "law = \"hunt_crossley\"\nexponent = 1.5\n"}) {
    CAPTURE(std::string(law));
    // With depth^1.5 the energy is off by some thousand tolerances after twenty contacts.
    const Run r = run(dropped(law), {"dop853", 1e-13, 20.0});
    const std::vector<double> closes = r.event_times("floor", "closes"), opens = r.event_times("floor", "opens");
    REQUIRE(closes.size() == 22);
    CHECK(opens.size() == closes.size());
    const double period = closes[1] - closes[0];
    for (std::size_t i = 1; i < closes.size(); ++i)
      // depth^1.5 has no second derivative where it starts: each contact's first step is off by a little
      CHECK(std::abs(closes[i] - closes[0] - static_cast<double>(i) * period) < 1e-8);
    CHECK(r.result.statistics.energy_residual < 1e-9); // of 9.81 J
    CHECK(r.result.statistics.dissipated == doctest::Approx(0.0).epsilon(1e-9));
    // Nothing but closing and opening: a force that grows from zero does not flicker.
    CHECK(r.result.events.size() == closes.size() + opens.size());
  }
}

TEST_CASE("Hunt-Crossley with exponent 1: the rebound follows its exact energy integral") {
  // m v dv/dδ = k|δ|(1 − α v̇…): with d = −δ, u = ḋ: u/(1 + αu) du = −(k/m) d dd without gravity, so that
  // u/α − ln(1 + αu)/α² is the same before and after the contact.
  const double alpha = 0.3, before = 2.0;
  const Run r = run(R"(
gravity = [0.0, 0.0]
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
position = [0.0, 0.1]
velocity = [0.0, -2.0]
[[element]]
kind = "unilateral_contact"
name = "floor"
a = "ball"
stiffness = 1e5
law = "hunt_crossley"
exponent = 1.0
dissipation = 0.3
)",
                    {"dop853", 1e-12, 0.2});
  const double after = r.last("ball.vy");
  const auto invariant = [&](double u) { return u / alpha - std::log1p(alpha * u) / (alpha * alpha); };
  CHECK(after > 0.0);
  CHECK(std::abs(invariant(-after) - invariant(before)) < 1e-10);
}

TEST_CASE("a contact at rest under its weight stays at rest") {
  const Run r = run(R"(
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
[[element]]
kind = "unilateral_contact"
name = "floor"
a = "ball"
stiffness = 1e5
damping = 20.0
preload = 9.81
)",
                    {"rk4", 1e-3, 10.0, 1.0});
  CHECK(r.result.events.empty());
  for (const double y : r.series("ball.y")) CHECK(std::abs(y) < 1e-18);
}

// At the instant at which a gap closes it is zero but for rounding, which has a sign: a contact that took it for tension would
// let what lands on it through until an event of its own found that out.
TEST_CASE("a contact that closes presses, damped or not, whatever rounding leaves of its gap") {
  for (const double damping : {0.0, 20.0})
    for (const double gap : {-1e-18, 0.0, 1e-18})
      for (const double rate : {-1.0, -1e-12, 0.0}) {
        const KelvinVoigtContact law{1e5, damping, 0.0};
        CHECK(law.next_mode(k_contact_open, 0, gap, rate, 1e-15) == k_contact_pressed);
      }
  // Drawn out of the ground faster than its spring follows it does not pull.
  CHECK(KelvinVoigtContact{1e5, 20.0, 0.0}.next_mode(k_contact_open, 0, -1e-6, 1.0, 1e-15) == k_contact_released);
}
