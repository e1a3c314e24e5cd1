// Friction above 1 on damped contacts. The normal force is a function of the state and not of the friction, so sliding is solvable
// for every coefficient: a block on a jerked deck starts, slides and stops as the closed form says.
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

struct Case {
  double mass = 1.0, stiffness = 1e6, damping = 0.0, mu_static = 1.0, mu_kinetic = 1.0;
  double jerk = 0.0, duration = 0.0; ///< acceleration of the deck, m/s², over that time from 0.01 s, s
  double ahead = 0.0, below = 0.0;   ///< of the contact: the deck's centre, m
  bool is_guided = true;
};

std::string text_of(const Case& c) {
  std::string text =
      "gravity = [0.0, -9.81]\n[[body]]\nname = \"block\"\nmass = " + number(c.mass) + "\ninertia = " + number(0.2 * c.mass) +
      "\n[[body]]\nname = \"deck\"\nmass = 5000\ninertia = 1000\nposition = [" + number(c.ahead) + ", " + number(c.below) +
      "]\n[[signal]]\nkind = \"rectangle\"\nname = \"jerk\"\npeak = " + number(c.jerk) +
      "\nstart = 0.01\nduration = " + number(c.duration) +
      "\n[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"deck\"\nsignal = \"jerk\"\nas = \"acceleration\"\n"
      "[[element]]\nkind = \"prismatic\"\nname = \"road\"\na = \"deck\"\n"
      "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot\"\na = \"block\"\nb = { body = \"deck\", at = [0.0, 0.0] }\nstiffness = " +
      number(c.stiffness) + "\ndamping = " + number(c.damping) + "\npreload = " + number(9.81 * c.mass) +
      "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"rubber\"\ncontacts = [\"foot\"]\nstatic_friction = " + number(c.mu_static) +
      "\nkinetic_friction = " + number(c.mu_kinetic) + "\n";
  if (c.is_guided) text += "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"block\"\n";
  return text;
}

} // namespace

// While the deck's centre lies under the contact, the lever of the angle of the deck is zero; from there it grows by any factor. No step
// may be refused for that.
TEST_CASE("a block slides on a jerked deck with friction above 1, whatever the damping and the levers") {
  random::RandomNumber draw(42);
  for (int i = 0; i < 300; ++i) {
    Case c;
    c.mass = draw.decades(0.0, 4.0);
    c.stiffness = c.mass * draw.decades(3.0, 6.0);
    const double ratio = draw.between(0.0, 1.0) < 0.2 ? 0.0 : draw.decades(-3.0, 0.5);
    c.damping = 2.0 * ratio * std::sqrt(c.stiffness * c.mass);
    c.mu_static = draw.between(0.8, 3.0);
    c.mu_kinetic = c.mu_static * (draw.between(0.0, 1.0) < 0.3 ? 1.0 : draw.between(0.4, 1.0));
    c.jerk = 9.81 * c.mu_static * draw.between(1.1, 3.0);
    c.duration = draw.between(0.02, 0.1);
    c.ahead = draw.between(0.0, 1.0) < 0.5 ? 0.0 : draw.between(-1e-2, 1e-2);
    c.below = draw.between(0.0, 1.0) < 0.5 ? 0.0 : draw.between(-1.0, 0.0);
    c.is_guided = draw.between(0.0, 1.0) < 0.5;
    static constexpr const char* methods[] = {"auto", "dop853", "tsit5", "rodas5p"};
    const char* const method = methods[i % 4];
    CAPTURE(i);
    CAPTURE(method);
    CAPTURE(c.damping);
    CAPTURE(c.mu_kinetic);
    const double a = 9.81 * c.mu_kinetic, v = c.jerk * c.duration, stops = 0.01 + v / a;
    const Run r = run(text_of(c), {method, 1e-8, 1.2 * stops});
    REQUIRE(r.result.stop_reason.empty());
    const auto began = r.event_times("rubber", "slips backward"), ended = r.event_times("rubber", "sticks");
    REQUIRE(began.size() == 1);
    REQUIRE(ended.size() == 1);
    CHECK(began.front() == doctest::Approx(0.01).epsilon(1e-12)); // a breakpoint of the signal
    // Steps of 1e-8 each, and a contact whose normal force is known to that: ten times it.
    CHECK(ended.front() == doctest::Approx(stops).epsilon(1e-7));
    const double slid = 0.5 * c.jerk * c.duration * c.duration + v * (stops - 0.01 - c.duration) - 0.5 * v * v / a;
    CHECK(r.last("rubber.slide") == doctest::Approx(-slid).epsilon(1e-6));
  }
}
