// What slides from the start says so: the first slip of a run is an event, whenever it is.
#include "mbd/trust/event_match.h"
#include "mbd/trust/global_error.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// A block of 10 kg, its centre in its sole, on a floor that is pressed by its weight, sliding at `speed` and pushed by `push` from the start.
std::string block(double speed, double push, double friction) {
  return signal_entry("constant", "push", "value = " + number(push)) +
         body("block", "mass = 10.0; inertia = 1.0; position = [0.0, 0.0]; velocity = [" + number(speed) + ", 0.0]") +
         element("unilateral_contact", "sole",
                 "a = { body = 'block', at = [0.0, 0.0] }; b = 'ground'; normal = [0.0, 1.0]; stiffness = 1e5; damping = 100.0; "
                 "preload = " +
                     number(10.0 * k_g)) +
         element("coulomb_stick", "friction", "contacts = ['sole']; static_friction = " + number(friction)) +
         element("load", "load", "at = 'block'; force_x = 'push'");
}

const char* const k_methods[] = {"rk4", "tsit5", "dop853", "rodas5p", "auto", "moreau"};

SimulationOptions settings_of(const std::string& method, double end) {
  SimulationOptions o = options({method, 1e-8, end, end});
  if (method == "rk4" || method == "moreau") o.settings.step = 1e-3;
  o.has_extremes = true;
  return o;
}

Run run_with(const std::string& method, const std::string& text, double end = 0.01) {
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  r.result = simulate(*r.system, r.system->initial_state(), settings_of(method, end));
  return r;
}

// Of the friction: the one event of a run that is too short for others.
void check_only(const std::string& text, EventKind kind) {
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run r = run_with(method, text);
    REQUIRE(r.result.events.size() == 1);
    CHECK(r.result.events[0].t == 0.0);
    CHECK(r.result.events[0].kind == kind);
    CHECK(r.result.events[0].is_at_start());
  }
}

void check_none(const std::string& text) {
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    CHECK(run_with(method, text).result.events.empty());
  }
}

} // namespace

TEST_CASE("what slides at the start, or is pushed beyond its bound there, slips at t = 0, whatever the method") {
  const double bound = 0.5 * 10.0 * k_g;
  check_only(block(1.0, 0.0, 0.5), EventKind::slips_forward);
  check_only(block(-1.0, 0.0, 0.5), EventKind::slips_backward);
  check_only(block(0.0, 1.01 * bound, 0.5), EventKind::slips_forward);
  check_only(block(0.0, -1.01 * bound, 0.5), EventKind::slips_backward);
  check_only(block(1.0, -2.0 * bound, 0.5), EventKind::slips_forward); // the way it moves, not the way it is pushed
}

TEST_CASE("what holds at the start, or never could, does not slip there") {
  const double bound = 0.5 * 10.0 * k_g;
  check_none(block(0.0, 0.99 * bound, 0.5));
  check_none(block(0.0, 0.0, 0.5));
  check_none(block(1.0, 0.0, 0.0)); // no friction: sliding is all it can do
  check_none(block(0.0, 10.0, 0.0));
}

TEST_CASE("friction of a joint's coordinate says so, too") {
  const auto wheel = [](double spin, double holds) {
    return "gravity = [0.0, 0.0]\n" + body("wheel", "mass = 1.0; inertia = 1.0; angular_velocity = " + number(spin)) +
           element("revolute", "pin", "a = 'wheel'") +
           element("joint_friction", "bearing", "a = 'wheel'; coordinate = 'angle'; holds = " + number(holds));
  };
  check_only(wheel(2.0, 1.0), EventKind::slips_forward);
  check_only(wheel(-2.0, 1.0), EventKind::slips_backward);
  check_none(wheel(0.0, 1.0));
}

TEST_CASE("the time of a slip from the start is exact, and its partner in a finer run is one from the start") {
  const std::string text = block(1.0, 0.0, 0.5);
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run r = run_with(method, text, 0.3); // stops after v/(μ g) = 0.204 s
    REQUIRE(r.result.events.size() == 2);
    CHECK(r.result.events[1].kind == EventKind::sticks);
    const GlobalErrorEstimate estimate = estimate_global_error(*r.system, r.system->initial_state(), settings_of(method, 0.3), r.result);
    CHECK(estimate.event_times[0] == 0.0);
    CHECK(estimate.event_times[1] > 0.0);
    CHECK(estimate.error.unmatched_events == 0);
  }
  // One that slips from the start against one that begins to later: neither has a partner.
  const std::vector<Event> mine{{0.0, "foot", EventKind::slips}}, theirs{{1e-3, "foot", EventKind::slips}};
  CHECK(match_events(mine, theirs).pairs.empty());
  CHECK(match_events(mine, mine).pairs.size() == 1);
}
