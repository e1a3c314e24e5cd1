// Ropes, bands and belts with friction on drums: Euler's and Eytelwein's ratio both ways, exact stick within it, what a slide costs.
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};
constexpr double k_mu = 0.25;

// A load hangs from a rope that lies half round a fixed drum; at the other end another load. Both go straight up and down.
std::string bollard(double first, double second, const std::string& more = "") {
  const auto hung = [](const char* name, double mass, double x) {
    return body(name, "mass = " + number(mass) + "; inertia = 0.1; position = " + point(x, -3.0)) +
           element("prismatic", std::string("guide of ") + name, std::string("a = '") + name + "'; axis = [0.0, 1.0]");
  };
  // From the first load, on the right, counter-clockwise over the drum to the second.
  return hung("first", first, 0.2) + hung("second", second, -0.2) +
         element("band", "rope",
                 "a = 'first'; b = 'second'; radius = 0.2; friction = 0.25; stiffness = 2e5; damping = 400.0; pretension = " +
                     number(9.81 * first) + more);
}

} // namespace

TEST_CASE("two loads on a rope over a fixed drum rest while their ratio is within e^{μα}, and else move as Euler's formula has it") {
  const double grip = std::exp(k_mu * k_pi); // 2.193
  // At rest nothing swings: the bound is met to three digits. Beyond it the loads run on until the lighter one is above the drum.
  for (const bool is_first_heavier : {false, true}) {
    const auto moved = [&](double heavy) {
      return std::abs(settle(is_first_heavier ? bollard(heavy, 10.0) : bollard(10.0, heavy)).q(1, 1) + 3.0);
    };
    CHECK(moved(21.9) < 0.01);
    CHECK(moved(22.0) > 1.0);
  }
  for (const double ratio : {1.0, 1.3, 3.0, 6.0})
    for (const bool is_first_heavier : {false, true}) {
      CAPTURE(ratio);
      CAPTURE(is_first_heavier);
      const double light = 10.0, heavy = light * ratio, first = is_first_heavier ? heavy : light, second = is_first_heavier ? light : heavy;
      const std::string text = bollard(first, second);
      const Run r = run(text, {"dop853", 1e-10, 1.0, 0.5});
      const double fell = r.last(is_first_heavier ? "first.y" : "second.y") + 3.0,
                   rose = r.last(is_first_heavier ? "second.y" : "first.y") + 3.0;
      if (ratio < grip) { // the rope stretches a little and swings there; nothing slides
        CHECK(r.event_times("rope", is_first_heavier ? "slips backward" : "slips forward").size() <= 4); // as it is let go
        CHECK(std::abs(fell) < 0.05);
        CHECK(r.last("rope.slip_rate") == 0.0);
      } else {
        CHECK(fell < -0.5 * 0.0001 * 0.9);
        CHECK(rose > 0.0);
      }
      const double a = r.last("rope.tension_a"), b = r.last("rope.tension_b");
      CHECK(std::max(a, b) <= std::min(a, b) * grip * (1.0 + 1e-9));
      if (ratio >= 3.0) {
        // Steady: m₁(g − w) = E m₂(g + w) with w the loads' acceleration, once the rope does not swing.
        const double w = 9.81 * (heavy - grip * light) / (heavy + grip * light);
        const double v = is_first_heavier ? r.last("first.vy") : r.last("second.vy");
        CHECK(v == doctest::Approx(-w).epsilon(0.02)); // after 1 s; it began with stretching
        CHECK(std::max(a, b) / std::min(a, b) == doctest::Approx(grip).epsilon(1e-9));
      }
    }
}

// Rounding may move what nothing moves: the first step is as long as the run, and its stages are then anywhere. Such a step is made again.
TEST_CASE("equal loads that hang at rest stay exactly where they are") {
  for (const char* method : {"dop853", "tsit5", "auto"}) {
    CAPTURE(std::string(method));
    const Run r = run(
        body("a", "mass = 10; inertia = 1; position = [-0.5, -2.0]") + body("b", "mass = 10; inertia = 1; position = [0.5, -2.0]") +
            element("prismatic", "guide of a", "a = 'a'; b = { body = 'ground', at = [-0.5, -2.0] }; axis = [0.0, 1.0]") +
            element("prismatic", "guide of b", "a = 'b'; b = { body = 'ground', at = [0.5, -2.0] }; axis = [0.0, 1.0]") +
            element("band", "rope", "a = 'a'; b = 'b'; radius = -0.5; friction = 0.3; stiffness = 1e6; damping = 1e4; pretension = 98.1"),
        {method, 1e-9, 1.0, 0.1});
    // Positions have a tolerance of 1e-9 of a thousandth of the radius of gyration, 3e-13 m, in each of some hundred steps.
    for (const char* name : {"a.y", "b.y"})
      for (const double y : r.series(name)) CHECK(std::abs(y + 2.0) < 1e-10);
    CHECK(r.result.events.empty());
  }
}

TEST_CASE("pulled at one end a held rope sticks, slides at T e^{μα}, and sticks again until T e^{-μα}, each to the digit") {
  // The end at a is fastened; at b a slide moves by x = 1 mm (1 − cos ω t), 4 s to and fro. Sticking with the way s slid: T_a = P + k s,
  // T_b = P + k (x − s) + c x'. It slides from T_b = E T_a on, sticks where ṡ = 0 and slides back from T_a = E T_b on.
  const double grip = std::exp(k_mu * k_pi), k = 1e5, c = 10.0, pretension = 50.0, omega = 0.5 * k_pi;
  const auto x = [&](double t) { return 1e-3 * (1.0 - std::cos(omega * t)); };
  const auto v = [&](double t) { return 1e-3 * omega * std::sin(omega * t); };
  const auto root = [](double low, double high, const auto& f) {
    for (int n = 0; n < 100; ++n) (f(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
    return low;
  };
  const std::string text = k_no_gravity + body("slide", "mass = 1.0; inertia = 0.1; position = [-0.2, -1.0]") +
                           signal_entry("haversine", "way", "peak = 2e-3; duration = 4.0") +
                           element("prismatic", "guide", "a = 'slide'; axis = [0.0, -1.0]") +
                           element("prescribed_motion", "pull",
                                   "a = 'slide'; b = { body = 'ground', at = [-0.2, -1.0], angle = -1.5707963267948966 }; coordinate = "
                                   "'x'; signal = 'way'; as = 'position'") +
                           element("band", "rope",
                                   "a = { body = 'ground', at = [0.2, -1.0] }; b = 'slide'; radius = 0.2; friction = 0.25; stiffness = "
                                   "1e5; damping = 10.0; pretension = 50.0");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 4.0, 0.1});
    const std::vector<double> slips = r.event_times("rope", "slips forward"), back = r.event_times("rope", "slips backward"),
                              sticks = r.event_times("rope", "sticks");
    REQUIRE(slips.size() == 1);
    REQUIRE(back.size() == 1);
    REQUIRE(sticks.size() >= 1);
    CHECK(std::abs(slips[0] - root(0.0, 2.0, [&](double t) { return pretension + k * x(t) + c * v(t) - grip * pretension; })) <
          1e-8); // what 1e-12 m stretch is slack: 6e-7 N of 100 N/s
    // τ ṡ = (k x + c x' − P (E − 1))/(k (1 + E)) − s with τ = c/k = 0.1 ms: s follows x, and has its most where x has, but for 1e-7 of it.
    CHECK(std::abs(sticks[0] - 2.0) < 1e-6);
    const double slid = (k * x(2.0) - pretension * (grip - 1.0)) / (k * (1.0 + grip));
    const std::vector<double> a = r.series("rope.tension_a"), b = r.series("rope.tension_b"), slip = r.series("rope.slip");
    for (int i = 21; 0.1 * i < back[0]; ++i) {
      CHECK(slip[static_cast<std::size_t>(i)] == doctest::Approx(slid).epsilon(1e-6));
      CHECK(slip[static_cast<std::size_t>(i)] == slip[21]); // exact stick
    }
    CHECK(b[15] / a[15] == doctest::Approx(grip).epsilon(1e-9));
    const double held = pretension + k * slip[21];
    CHECK(std::abs(back[0] - root(2.0, 4.0, [&](double t) { return held - grip * (pretension + k * (x(t) - slip[21]) + c * v(t)); })) <
          1e-8);
    CHECK(a[39] / b[39] == doctest::Approx(grip).epsilon(1e-9));
  }
}

TEST_CASE("what a slide takes from the drum's motion is heat: energies balance, by all methods alike") {
  const std::string text =
      k_no_gravity + body("drum", "mass = 5.0; inertia = 0.4; angular_velocity = 30.0") + element("revolute", "axle", "a = 'drum'") +
      body("weight", "mass = 2.0; inertia = 0.1; position = [0.3, -2.0]") +
      element("prismatic", "guide", "a = 'weight'; axis = [0.0, 1.0]") +
      element("spring_damper", "spring", "a = 'weight'; b = { body = 'ground', at = [0.3, -4.0] }; stiffness = 900.0") +
      element("band", "band",
              "a = 'weight'; b = { body = 'ground', at = [-0.3, -1.0] }; drum = 'drum'; radius = 0.3; friction = 0.3; stiffness = 3e4; "
              "damping = 60.0; pretension = 40.0");
  double before = 0.0;
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-10, 2.0, 0.1});
    CHECK(std::abs(r.result.statistics.energy_residual) < 1e-5); // of 180 J
    const double spin = r.last("drum.omega");
    if (before != 0.0) CHECK(std::abs(spin - before) < 1e-6);
    before = spin;
  }
}

TEST_CASE("a band brake that grips itself, and one that does not: their couples stand as e^{μα} to 1") {
  // A lever pulls one end with F; the other is fastened. Turning away from the fastened end its pull is F E: M = F r (E − 1); the other way F/E.
  const double grip = std::exp(0.3 * k_pi), pull = 100.0, r = 0.15;
  const auto couple = [&](double spin) {
    const std::string text = k_no_gravity + body("drum", "mass = 10.0; inertia = 50.0; angular_velocity = " + number(spin)) +
                             element("revolute", "axle", "a = 'drum'") +
                             body("slide", "mass = 1.0; inertia = 0.1; position = [-0.15, -1.0]") +
                             element("prismatic", "guide", "a = 'slide'; axis = [0.0, 1.0]") +
                             element("spring_damper", "calm", "a = 'slide'; axis = [0.0, 1.0]; damping = 300.0") +
                             element("load", "lever", "at = 'slide'; force = [0.0, -100.0]") +
                             element("band", "brake",
                                     "a = { body = 'ground', at = [0.15, -1.0] }; b = 'slide'; drum = 'drum'; radius = 0.15; friction = "
                                     "0.3; stiffness = 2e5; damping = 100.0; pretension = 100.0");
    const Run run_of = run(text, {"dop853", 1e-9, 3.0, 1.0});
    CHECK(run_of.last("brake.mode") == 2.0);
    return run_of.last("brake.couple");
  };
  // Counter-clockwise the drum drags the band away from a, where it is fastened: its pull there rises.
  CHECK(couple(10.0) == doctest::Approx(pull * r * (1.0 - grip)).epsilon(1e-4));
  CHECK(couple(-10.0) == doctest::Approx(pull * r * (1.0 - 1.0 / grip)).epsilon(1e-4));
}

TEST_CASE("a belt drive transmits r (T_1 − T_2) until the smaller wheel slides at (2 P) (E − 1)/(E + 1)") {
  // Both free parts stretch alike, so T_1 + T_2 = 2 P. A motor's couple rises; the second wheel is held by a brake that the belt would overcome.
  const double small = 0.1, large = 0.3, apart = 1.0, pretension = 200.0, angle = k_pi - 2.0 * std::asin((large - small) / apart);
  for (const bool is_crossed : {false, true}) {
    CAPTURE(is_crossed);
    const double wrapped = is_crossed ? k_pi + 2.0 * std::asin((large + small) / apart) : angle, grip = std::exp(0.35 * wrapped);
    const double most = small * 2.0 * pretension * (grip - 1.0) / (grip + 1.0);
    for (const double share : {0.98, 1.02}) {
      CAPTURE(share);
      const std::string text = k_no_gravity + body("small", "mass = 1.0; inertia = 0.01") + element("revolute", "axle", "a = 'small'") +
                               body("large", "mass = 5.0; inertia = 0.3; position = [1.0, 0.0]") + element("weld", "brake", "a = 'large'") +
                               signal_entry("triangle", "rise", "duration = 2.0; peak = " + number(share * most)) +
                               element("load", "motor", "at = 'small'; torque = 'rise'") +
                               element("rotational_spring_damper", "calm", "a = 'small'; damping = 0.02") +
                               element("belt", "belt",
                                       "a = 'small'; b = 'large'; radius_a = 0.1; radius_b = 0.3; friction_a = 0.35; friction_b = 0.35; "
                                       "stiffness = 1e5; damping = 200.0; pretension = 200.0" +
                                           std::string(is_crossed ? "; crossed = true" : ""));
      const Run r = run(text, {"dop853", 1e-10, 1.0, 0.1});
      CHECK(r.last("belt.tension_1") + r.last("belt.tension_2") == doctest::Approx(2.0 * pretension).epsilon(1e-9));
      CHECK((r.event_times("belt").empty()) == (share < 1.0));
      if (share > 1.0) { // the damper at the wheel takes c ω of it, with ω the rate at which the belt gives
        CHECK(std::abs(r.event_times("belt")[0] - 1.0 / share) < 2e-5);
        CHECK(r.last("belt.mode") == 2.0);
      }
    }
  }
}

TEST_CASE("a belt without slide turns its wheels as their radii stand; crossed against each other") {
  for (const bool is_crossed : {false, true}) {
    const std::string text =
        k_no_gravity + body("small", "mass = 1.0; inertia = 0.01; angular_velocity = 30.0") + element("revolute", "axle", "a = 'small'") +
        body("large", "mass = 5.0; inertia = 0.3; position = [1.0, 0.0]; angular_velocity = " + number(is_crossed ? -10.0 : 10.0)) +
        element("revolute", "other axle", "a = 'large'; b = { body = 'ground', at = [1.0, 0.0] }") +
        element("belt", "belt",
                "a = 'small'; b = 'large'; radius_a = 0.1; radius_b = 0.3; friction_a = 0.35; friction_b = 0.35; stiffness = 1e5; damping "
                "= 200.0; pretension = 200.0" +
                    std::string(is_crossed ? "; crossed = true" : ""));
    const Run r = run(text, {"dop853", 1e-11, 2.0, 1.0});
    CHECK(r.last("small.omega") == doctest::Approx(30.0).epsilon(1e-9)); // nothing brakes: no creep, no drag
    CHECK(r.last("large.omega") == doctest::Approx(is_crossed ? -10.0 : 10.0).epsilon(1e-9));
    CHECK(r.event_times("belt").empty());
  }
}

TEST_CASE("a rope that goes slack lets both loads fall, and holds them again when it is taut") {
  // Both ends are thrown up: the rope is loose until they have come back to where it is taut.
  const std::string text = bollard(10.0, 10.0) + "";
  Model model = scene(text + k_head);
  for (Body& b : model.bodies) b.velocity = {0.0, 2.0};
  const Run r = run(model, {"dop853", 1e-11, 1.0, 0.01});
  const std::vector<double> loose = r.event_times("rope", "enters its gap"), taut = r.event_times("rope", "closes its gap");
  REQUIRE(loose.size() >= 1);
  REQUIRE(taut.size() >= 1);
  // Free flight from where it went loose, alike on both sides: back at the same height after 2 v/g.
  const double flight = taut[0] - loose[0];
  CHECK(flight > 0.3);
  CHECK(flight < 2.0 * 2.0 / 9.81);
  CHECK(r.last("first.y") == doctest::Approx(r.last("second.y")).epsilon(1e-9)); // the mirror's symmetry
}

TEST_CASE("what is wrong with a band is told") {
  const auto complaint = [](const std::string& fields) {
    try {
      (void)compile(scene(body("load", "mass = 1.0; inertia = 0.1; position = [0.2, -1.0]") + element("band", "band", fields) + k_head));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto says = [&](const std::string& fields, const std::string& part) {
    const std::string text = complaint(fields);
    CHECK_MESSAGE(text.find(part) != std::string::npos, text);
  };
  const std::string rest = "; friction = 0.2; stiffness = 1e4; damping = 10.0",
                    ends = "a = 'load'; b = { body = 'ground', at = [-0.2, -1.0] }";
  CHECK(complaint(ends + "; radius = 0.2" + rest) == "nothing");
  says(ends + "; radius = 0.0" + rest, "a point holds nothing by friction");
  says(ends + "; radius = 2.0" + rest, "a straight part takes more than 2 m");
  says("a = 'load'; drum = 'load'; radius = 0.2" + rest, "fastened to a drum that moves");
  says(ends + "; radius = 0.2; pretension = 1.0; slack = 0.1" + rest, "give either 'pretension' or 'slack'");
  says(ends + "; radius = 0.2; friction = 0.2; stiffness = 1e4; damping = 0.0", "damping");
  says(ends + "; radius = 0.2; friction = 0.2; stiffness = 1e4", "damping");
}
