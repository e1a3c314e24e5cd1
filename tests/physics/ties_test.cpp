// Frictions that reach their bounds at the same instant: those slide that then have a rate, whatever rounding does.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

using namespace steplap;
using namespace steplap::testing;
using random::RandomNumber;

namespace {

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return std::strpbrk(text, ".en") ? text : std::string(text) + ".0";
}

std::string listed(const std::vector<Event>& events) {
  std::string text;
  for (const Event& event : events) text += digits(event.t) + " " + event.element + " " + event.words() + "\n";
  return text;
}

} // namespace

// Three masses of 1 kg in a stack on a deck that brakes ever more. Friction below them bears 12, 8 and 4 N, all of it reached at 1 s,
// and sliding 9, 6 and 3 N. The stack slides on the deck and is braked with 3 m/s²; what holds it together bears 6 and 3 N and holds,
// with a tug of 1 N from 1.5 s on, too. At 2 s: ½ · 4 + 3 · 0.5 + (9 − 1)/3 · 0.5 = 29/6 m/s.
TEST_CASE("ties: what is relieved by another slip holds") {
  const Model model = read_model(STEPLAP_TEST_DATA "/defects/tie_then_tug.toml", transformer_catalog());
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4"}) {
    CAPTURE(std::string(method));
    const Run stack = run(model, {method, std::string(method) == "rk4" ? 1e-3 : 1e-9, 2.0});
    CAPTURE(listed(stack.result.events));
    REQUIRE(stack.result.events.size() == 1);
    CHECK(stack.result.events[0].element == "f0");
    CHECK(is_slip(stack.result.events[0].kind));
    CHECK(stack.result.events[0].t == doctest::Approx(1.0).epsilon(1e-9));
    for (const char* mass : {"m0.vx", "m1.vx", "m2.vx"}) CHECK(stack.last(mass) == doctest::Approx(29.0 / 6.0).epsilon(1e-8));
  }
}

// Stacks of other heights and masses, where rounding may let one bound be reached before the others: any of them may be the one that
// gives way, but what is said to slip does.
TEST_CASE("ties: nothing is said to slip that has no rate") {
  constexpr double k_sample = 0.01; // s
  int slips = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    RandomNumber random(seed);
    const int count = 2 + random.below(4);
    const bool is_even = random.chance(0.5); // then all bounds are reached in one step of rounding
    const double share = 0.25 * (1.0 + random.below(3)), most = 2.0 + random.below(4);
    std::vector<double> masses;
    double above = 0.0;
    for (int i = 0; i < count; ++i) masses.push_back(is_even ? 1.0 : 1.0 + random.below(4));
    for (const double m : masses) above += m;
    std::string text = k_no_gravity + signal_entry("trapezoid", "a", "peak = 6.0; duration = 3.0; rise = 1.5; fall = 0.0") +
                       body("deck", "mass = 10.0; inertia = 1.0") + element("prismatic", "road", "a = 'deck'") +
                       element("prescribed_motion", "drive", "a = 'deck'; signal = 'a'");
    for (int i = 0; i < count; ++i) {
      const std::string m = "m" + std::to_string(i), below = i == 0 ? "deck" : "m" + std::to_string(i - 1);
      text += body(m, "mass = " + digits(masses[i]) + "; inertia = 1.0") +
              element("prismatic", "g" + std::to_string(i), "a = '" + m + "'") +
              element("joint_friction", "f" + std::to_string(i),
                      "a = '" + m + "'; b = '" + below + "'; coordinate = 'x'; holds = " + digits(above * most) +
                          "; drags = " + digits(share * above * most));
      above -= masses[i];
    }
    for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4"}) {
      CAPTURE(std::string(method));
      const Run stack = run(text, {method, std::string(method) == "rk4" ? 1e-3 : 1e-9, 1.9, k_sample});
      CAPTURE(listed(stack.result.events));
      const double begin = most / 4.0; // s: 6 m/s² in 1.5 s
      REQUIRE(!stack.result.events.empty());
      CHECK(stack.result.events.front().t == doctest::Approx(begin).epsilon(1e-8));
      for (const Event& event : stack.result.events) {
        CHECK(event.kind != EventKind::sticks); // what slides does so to the end: the deck brakes more than all it drags
        if (!is_slip(event.kind)) continue;
        ++slips;
        // Kinetic friction is at least a quarter below static friction, so 10 ms later a sliding element has a rate.
        const auto row = static_cast<std::size_t>(std::ceil(event.t / k_sample)) + 1;
        CHECK(std::abs(stack.series(event.element + ".slip_rate").at(row)) > 1e-4);
      }
    }
  }
  CHECK(slips >= 300); // each run has one
}
