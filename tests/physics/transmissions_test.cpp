// Freewheels and gears with losses against closed forms.
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};

std::string wheel(const std::string& name, double inertia, double omega = 0.0) {
  return body(name, "mass = 1.0; inertia = " + number(inertia) + "; angular_velocity = " + number(omega)) +
         element("revolute", "axle of " + name, "a = '" + name + "'");
}

} // namespace

TEST_CASE("a freewheel takes a along while b is pushed, and lets it run on when b is braked") {
  // b is driven by M(t), 6 N m to 1 s, then −3 N m. Locked to 1 s: ω = 6 t/(J_a + J_b). Then a runs on with ω = const less its drag.
  for (const bool is_clockwise : {false, true}) {
    const double sign = is_clockwise ? -1.0 : 1.0;
    for (const double drags : {0.0, 0.2}) {
      const std::string text =
          k_no_gravity + wheel("hub", 2.0) + wheel("pedals", 1.0) + signal_entry("constant", "brake", "value = " + number(-3.0 * sign)) +
          signal_entry("rectangle", "tread", "peak = " + number(9.0 * sign) + "; duration = 1.0") +
          signal_entry("sum", "push", "signals = ['brake', 'tread']") + element("load", "foot", "at = 'pedals'; torque = 'push'") +
          element("freewheel", "freewheel",
                  "a = 'hub'; b = 'pedals'; drags = " + number(drags) + (is_clockwise ? "; free = 'clockwise'" : ""));
      for (const char* method : k_methods) {
        CAPTURE(method);
        CAPTURE(is_clockwise);
        CAPTURE(drags);
        const Run r = run(text, {method, 1e-11, 2.0, 0.5});
        const std::vector<double> hub = r.series("hub.omega"), pedals = r.series("pedals.omega"), couple = r.series("freewheel.couple");
        CHECK(std::abs(hub[1] - sign * 6.0 * 0.5 / 3.0) < 1e-10);
        CHECK(std::abs(hub[1] - pedals[1]) < 1e-12); // exact
        CHECK(couple[1] == doctest::Approx(sign * 4.0));
        CHECK(std::abs(hub[4] - sign * (2.0 - drags / 2.0 * 1.0)) < 1e-9);
        CHECK(std::abs(pedals[4] - sign * (2.0 + (drags - 3.0) * 1.0)) < 1e-9);
        CHECK(couple[4] == doctest::Approx(-sign * drags));
        REQUIRE(r.event_times("freewheel").size() == 1);
        CHECK(std::abs(r.event_times("freewheel")[0] - 1.0) < 1e-12);
      }
    }
  }
}

TEST_CASE("a backstop holds a load whose motor fails, at rest from the moment at which it would fall back") {
  // A drum with a hanging load, backstop to the ground: hoisted with 1 m/s it stops after v²/(2 a) and stays.
  const std::string text = body("load", "mass = 100.0; inertia = 1.0; velocity = [0.0, 1.0]") +
                           body("drum", "mass = 10.0; inertia = 0.5; position = [-0.2, 5.0]; angular_velocity = 5.0") +
                           element("revolute", "axle", "a = 'drum'; b = { body = 'ground', at = [-0.2, 5.0] }") +
                           element("prismatic", "guide", "a = 'load'; axis = [0.0, 1.0]") +
                           element("rack", "rope", "a = 'drum'; b = 'load'; radius = 0.2; axis = [0.0, 1.0]") +
                           element("freewheel", "backstop", "a = 'drum'");
  const double deceleration = 100.0 * k_g / (100.0 + 0.5 / 0.04);
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 2.0, 0.5});
    CHECK(std::abs(r.event_times("backstop", "sticks").at(0) - 1.0 / deceleration) < 1e-9);
    CHECK(r.last("load.y") == doctest::Approx(0.5 / deceleration).epsilon(1e-9));
    CHECK(std::abs(r.last("load.vy")) < 1e-12);
    CHECK(std::abs(r.last("backstop.couple")) == doctest::Approx(100.0 * k_g * 0.2).epsilon(1e-9));
  }
}

TEST_CASE("a backstop bears a load at rest, and not the other way round") {
  const auto hung = [](const std::string& free) {
    return body("load", "mass = 100.0; inertia = 1.0") + body("drum", "mass = 10.0; inertia = 0.5; position = [-0.2, 5.0]") +
           element("revolute", "axle", "a = 'drum'; b = { body = 'ground', at = [-0.2, 5.0] }") +
           element("prismatic", "guide", "a = 'load'; axis = [0.0, 1.0]") +
           element("spring_damper", "weak", "a = 'load'; b = { body = 'ground', at = [0.0, 9.0] }; stiffness = 1e4") +
           element("rack", "rope", "a = 'drum'; b = 'load'; radius = 0.2; axis = [0.0, 1.0]") +
           element("freewheel", "backstop", "a = 'drum'; free = '" + free + "'");
  };
  CHECK(std::abs(settle(hung("counter_clockwise")).q(1, 1)) < 1e-9);
  CHECK(settle(hung("clockwise")).q(1, 1) == doctest::Approx(-100.0 * k_g / 1e4).epsilon(1e-6)); // down to where the spring bears it
}

TEST_CASE("a backstop and a brake on one axle: what the brake cannot hold the backstop does, one way; the other way the brake is alone") {
  for (const bool is_held : {true, false})
    for (const double holds : {50.0, 300.0}) {
      CAPTURE(is_held);
      CAPTURE(holds);
      const std::string text = k_no_gravity + wheel("drum", 0.5) +
                               element("load", "load", "at = 'drum'; couple = " + number(is_held ? -196.2 : 196.2)) +
                               element("freewheel", "backstop", "a = 'drum'") +
                               element("joint_friction", "brake", "a = 'drum'; coordinate = 'angle'; holds = " + number(holds));
      const Run r = run(text, {"dop853", 1e-10, 1.0, 0.5});
      CHECK(r.last("drum.omega") == doctest::Approx(is_held || holds > 196.2 ? 0.0 : (196.2 - holds) / 0.5));
      CHECK(std::abs(r.last("brake.friction")) <= holds * (1.0 + 1e-12));
      CHECK(r.last("backstop.couple") >= -1e-9);
    }
}

TEST_CASE("a freewheel that holds only so much slips beyond it") {
  const std::string text = k_no_gravity + wheel("hub", 1.0) + wheel("pedals", 1.0) +
                           element("load", "foot", "at = 'pedals'; couple = 10.0") +
                           element("freewheel", "freewheel", "a = 'hub'; b = 'pedals'; holds = 3.0");
  const Run r = run(text, {"dop853", 1e-11, 1.0, 0.5});
  CHECK(r.last("hub.omega") == doctest::Approx(3.0));
  CHECK(r.last("pedals.omega") == doctest::Approx(7.0));
  CHECK(std::abs(r.result.statistics.dissipated - 3.0 * 0.5 * 4.0) < 1e-8); // M times the angle between them
}

TEST_CASE("a gear with losses passes on η of the power forwards and 2 − 1/η of it backwards") {
  // Steady: driven by a couple at one shaft, braked in proportion to the speed at the other.
  for (const double ratio : {3.0, -3.0})
    for (const double efficiency : {0.6, 0.9}) {
      CAPTURE(ratio);
      CAPTURE(efficiency);
      const std::string gear = element("lossy_gear", "gear",
                                       "a = 'fast'; b = 'slow'; ratio = " + number(ratio) + "; efficiency = " + number(efficiency) +
                                           "; stiffness = 5e3; damping = 5.0");
      const std::string shafts = k_no_gravity + wheel("fast", 0.05) + wheel("slow", 0.4);
      const Run forwards = run(shafts + gear + element("load", "motor", "at = 'fast'; couple = 4.0") +
                                   element("rotational_spring_damper", "brake", "a = 'slow'; damping = 2.0"),
                               {"dop853", 1e-9, 12.0, 6.0});
      const double driven = 2.0 * std::pow(forwards.last("slow.omega"), 2), driving = 4.0 * forwards.last("fast.omega");
      CHECK(driven / driving == doctest::Approx(efficiency).epsilon(1e-6));
      const Run backwards = run(shafts + gear + element("load", "motor", "at = 'slow'; couple = 12.0") +
                                    element("rotational_spring_damper", "brake", "a = 'fast'; damping = 0.2"),
                                {"dop853", 1e-9, 12.0, 6.0});
      CHECK(0.2 * std::pow(backwards.last("fast.omega"), 2) / (12.0 * backwards.last("slow.omega")) ==
            doctest::Approx(2.0 - 1.0 / efficiency).epsilon(1e-6));
    }
}

TEST_CASE("with half or less it locks itself: no load at the slow shaft turns the fast one") {
  for (const double efficiency : {0.499, 0.3}) {
    CAPTURE(efficiency);
    for (const char* method : k_methods) {
      CAPTURE(method);
      const std::string text =
          k_no_gravity + wheel("worm", 0.01) + wheel("wheel", 0.4) + element("load", "load", "at = 'wheel'; couple = 500.0") +
          element("lossy_gear", "gear",
                  "a = 'worm'; b = 'wheel'; ratio = 30.0; efficiency = " + number(efficiency) + "; stiffness = 2e3; damping = 0.5");
      const Run r = run(text, {method, 1e-9, 1.0, 0.5});
      CHECK(std::abs(r.last("worm.theta")) < 1e-12);
      CHECK(r.last("gear.mode") == 1.0);
      CHECK(r.last("wheel.theta") == doctest::Approx(500.0 / (2e3 * 900.0)).epsilon(1e-3)); // the teeth give, and stay
    }
  }
  const std::string open =
      k_no_gravity + wheel("worm", 0.01) + wheel("wheel", 0.4) + element("load", "load", "at = 'wheel'; couple = 500.0") +
      element("lossy_gear", "gear", "a = 'worm'; b = 'wheel'; ratio = 30.0; efficiency = 0.55; stiffness = 2e3; damping = 0.5");
  // Above: it runs. (J_b + i² J_a/(2 − 1/η)) ω' = M, with the loss on shaft a.
  const double back = 2.0 - 1.0 / 0.55, rate = 500.0 / (0.4 + 900.0 * 0.01 / back);
  CHECK(run(open, {"dop853", 1e-9, 1.0, 0.5}).last("wheel.omega") == doctest::Approx(rate).epsilon(2e-3)); // but for the teeth's swing
}

TEST_CASE("what is wrong with them is told") {
  const auto complaint = [](const std::string& text) {
    try {
      (void)compile(scene(k_no_gravity + wheel("a", 1.0) + wheel("b", 1.0) + text + k_head));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto says = [&](const std::string& text, const std::string& part) {
    const std::string found = complaint(text);
    CHECK_MESSAGE(found.find(part) != std::string::npos, found);
  };
  says(element("freewheel", "f", "a = 'a'; b = 'a'"), "two different bodies");
  says(element("freewheel", "f", "a = 'a'; b = 'b'; holds = 1.0; drags = 2.0"), "'drags' must be less than 'holds'");
  says(element("lossy_gear", "g", "a = 'a'; b = 'a'; ratio = 2.0; stiffness = 1.0"), "have to be three bodies");
  says(element("lossy_gear", "g", "a = 'a'; b = 'b'; ratio = 0.0; stiffness = 1.0"), "'ratio' is 0");
  says(element("lossy_gear", "g", "a = 'a'; b = 'b'; ratio = 2.0; stiffness = 1.0; efficiency = 1.5"), "efficiency");
}
