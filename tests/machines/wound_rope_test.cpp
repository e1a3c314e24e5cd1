// Hoists and belts: ropes that are wound on wheels, against closed forms.
#include "tests/machines/written.h"
#include "tests/physics/model_text.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_tolerance = 1e-10;
const char* const k_methods[] = {"auto", "dop853", "tsit5", "rodas5p"};

std::string settings(double end, const std::string& more = "") {
  return "[simulation]\nend = " + number(end) + "\ntolerance = 1e-10\n[output]\nstep = " + number(end / 200.0) + "\n" + more;
}

std::string wheel(const std::string& name, double mass, double inertia, const std::string& at) {
  return body(name, "mass = " + number(mass) + "; inertia = " + number(inertia) + "; position = " + at) +
         element("revolute", name + " bearing", "a = '" + name + "'; b = { body = 'ground', at = " + at + " }");
}

double at_time(const Run& run, const std::string& channel, double t) {
  const auto& all = *run.result.trajectory;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all.times()[i] >= t - 1e-9) return all.value(i, all.column(channel));
  return std::nan("");
}

} // namespace

// With e = y − r θ, downwards: ë = g − k e (1/m + r²/J), e = (g/ω²)(1 − cos ωt), and m ÿ = m g − k e twice integrated.
TEST_CASE("a load runs down from its drum as rope and inertias say") {
  const double m = 50.0, inertia = 0.8, r = 0.2, k = 2e5, end = 1.5;
  const double square = k * (1.0 / m + r * r / inertia), omega = std::sqrt(square);
  const double fallen = 0.5 * k_g * end * end - k / m * k_g / square * (0.5 * end * end + (std::cos(omega * end) - 1.0) / square);
  const double stretch = k_g / square * (1.0 - std::cos(omega * end));
  for (const double side : {1.0, -1.0}) // on the right turning counter-clockwise winds up, on the left clockwise
    for (const std::string method : k_methods) {
      CAPTURE(side);
      CAPTURE(method);
      const std::string radius = number(side * r);
      const Written model(settings(end) + wheel("drum", 30.0, inertia, "[0.0, 5.0]") +
                          body("load", "mass = 50.0; inertia = 1.0; position = [" + radius + ", 4.0]") +
                          element("wound_rope", "rope", "a = 'drum'; b = 'load'; radius_a = " + radius + "; stiffness = 2e5"));
      const Run run = run_model(model.loaded({"simulation.integrator=" + method}));
      REQUIRE_FALSE(run.failure);
      // 14 swings at 1e-10 a step; positions of metres.
      CHECK(std::abs(last(run, "load.y") - (4.0 - fallen)) < 1e-8);
      CHECK(std::abs(last(run, "drum.theta") + side * (fallen - stretch) / r) < 1e-7);
      CHECK(std::abs(last(run, "rope.stretch") - stretch) < 1e-8);
      CHECK(std::abs(last(run, "rope.length") - (1.0 + fallen)) < 1e-8);
      CHECK(std::abs(last(run, "load.x") - side * r) < 1e-12); // the straight part stays upright
    }
}

// A thread that winds itself on a fixed cylinder: with φ the angle of its straight part ℓ = ℓ₀ + R φ, ℓ φ'' + R φ'² + g
// sin φ = 0.
TEST_CASE("a pendulum whose thread winds itself on a cylinder") {
  const double R = 0.1, length = 1.0, start = 1.0, end = 3.0;
  const auto rates = [&](const std::array<double, 2>& y) -> std::array<double, 2> {
    return {y[1], -(R * y[1] * y[1] + k_g * std::sin(y[0])) / (length + R * (y[0] - start))};
  };
  std::array<double, 2> y{start, 0.0};
  const int steps = 20000; // of fourth order: 1e-13
  for (int i = 0; i < steps; ++i) {
    const double h = end / steps;
    const auto moved = [](const std::array<double, 2>& from, double by, const std::array<double, 2>& k) -> std::array<double, 2> {
      return {from[0] + by * k[0], from[1] + by * k[1]};
    };
    const auto k1 = rates(y), k2 = rates(moved(y, 0.5 * h, k1)), k3 = rates(moved(y, 0.5 * h, k2)), k4 = rates(moved(y, h, k3));
    for (int j = 0; j < 2; ++j) y[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
  }
  const auto place = [&](double angle) {
    return std::array<double, 2>{R * std::cos(angle) + (length + R * (angle - start)) * std::sin(angle),
                                 R * std::sin(angle) - (length + R * (angle - start)) * std::cos(angle)};
  };
  const auto first = place(start), expected = place(y[0]);
  double before = 1.0;
  for (const double stiffness : {1e6, 1e7}) { // the bob's position by the rope's stretch, of the order of m g/k
    const Written model(
        settings(end) + body("bob", "mass = 2.0; inertia = 0.01; position = [" + number(first[0]) + ", " + number(first[1]) + "]") +
        element("wound_rope", "thread", "a = 'ground'; b = 'bob'; radius_a = 0.1; damping = 2e3; stiffness = " + number(stiffness)));
    const Run run = run_model(model.loaded({"simulation.integrator=rodas5p"}));
    REQUIRE_FALSE(run.failure);
    const double off = std::hypot(last(run, "bob.x") - expected[0], last(run, "bob.y") - expected[1]);
    CHECK(off < 20.0 * 2.0 * k_g / stiffness);
    CHECK(off < 0.2 * before); // and goes with it
    before = off;
  }
}

// Both sides of an open belt taut, e = r₁θ₁ − r₂θ₂: ë = M r₁/J₁ − 2 k e (r₁²/J₁ + r₂²/J₂). The slack side has lost its
// tension T₀ where k e = T₀; from there one side alone carries.
TEST_CASE("a belt drive: bearings, its mode, and when its slack side goes slack") {
  const double k = 4e4, r1 = 0.1, r2 = 0.25, J1 = 0.02, J2 = 0.6, tight = 300.0, apart = 0.8;
  const double couple = 60.0;
  const std::string belt = "stiffness = 4e4; pretension = 300.0; a = 'small'; b = 'large'; ";
  const std::string drive = k_no_gravity + settings(0.05) + wheel("small", 2.0, J1, "[0.0, 0.0]") + wheel("large", 8.0, J2, "[0.8, 0.0]") +
                            element("wound_rope", "above", belt + "radius_a = 0.1; radius_b = -0.25") +
                            element("wound_rope", "below", belt + "radius_a = -0.1; radius_b = 0.25") +
                            element("load", "motor", "at = 'small'; couple = 60.0");
  const Written model(drive);
  const double square = 2.0 * k * (r1 * r1 / J1 + r2 * r2 / J2), omega = std::sqrt(square);
  const double slack_at = std::acos(1.0 - tight / k * square * J1 / (couple * r1)) / omega;
  REQUIRE(slack_at < 0.05);
  for (const std::string method : k_methods) {
    CAPTURE(method);
    const Run run = run_model(model.loaded({"simulation.integrator=" + method}));
    REQUIRE_FALSE(run.failure);
    const auto slack =
        std::find_if(run.result.events.begin(), run.result.events.end(), [](const Event& e) { return e.kind == EventKind::enters_gap; });
    REQUIRE(slack != run.result.events.end());
    CHECK(slack->element == "below"); // counter-clockwise the small wheel winds up above what it lets go below
    CHECK(std::abs(slack->t - slack_at) < 1e-9);
    CHECK(std::abs(at_time(run, "small bearing.force_x", 0.0) + 2.0 * tight * std::sqrt(1.0 - std::pow((r2 - r1) / apart, 2))) <
          1e-9 * tight);
    // Taut or not, what drives is couple over both inertias: J₁ω₁ r₂ + J₂ω₂ r₁ = M r₂ t.
    CHECK(std::abs(J1 * last(run, "small.omega") * r2 + J2 * last(run, "large.omega") * r1 - couple * r2 * 0.05) < 1e-8);
  }
  const Written held(drive.substr(0, drive.find("[[element]]\nkind = \"load\"")));
  const Answer modes = steplap_does({"modes", held.file.string()});
  CAPTURE(modes.out);
  char text[40];
  std::snprintf(text, sizeof text, "%.4f Hz", omega / (2.0 * std::numbers::pi));
  CHECK(has(modes.out, text));
}

// Weston's hoist: two radii of one drum, the load's sheave in the bight. A turn lifts by π (R − r), and W (R − r)/2
// holds it.
TEST_CASE("a differential hoist holds its load with half the difference of its radii") {
  const double R = 0.20, r = 0.16, weight = 1000.0 * k_g, turned = 6.0 * std::numbers::pi;
  const std::string rope = "a = 'drum'; b = 'sheave'; stiffness = 1e8; damping = 1e5; ";
  const Written model(settings(4.0) + wheel("drum", 40.0, 1.0, "[0.0, 5.0]") +
                      body("sheave", "mass = 1000.0; inertia = 5.0; position = [0.02, 2.0]") +
                      element("wound_rope", "right part", rope + "radius_a = 0.2; radius_b = -0.18") +
                      element("wound_rope", "left part", rope + "radius_a = -0.16; radius_b = 0.18") +
                      signal_entry("haversine", "turning", "peak = " + number(2.0 * turned / 4.0) + "; duration = 4.0") +
                      element("prescribed_motion", "crank", "a = 'drum'; coordinate = 'angle'; signal = 'turning'; as = 'velocity'"));
  const auto loaded = model.loaded({"simulation.initial=equilibrium"});
  const Equilibrium rest = equilibrium_of(*loaded);
  CHECK(std::abs(at_rest(*loaded, rest, "crank.reaction") - 0.5 * weight * (R - r)) < 1e-6 * weight * R);
  CHECK(std::abs(at_rest(*loaded, rest, "left part.tension") - 0.5 * weight) < 1e-6 * weight);
  const double sag = 0.5 * weight / 1e8;
  CHECK(std::abs(at_rest(*loaded, rest, "sheave.y") - (2.0 - sag)) < 1e-9);
  const Run run = run_model(loaded);
  REQUIRE_FALSE(run.failure);
  // At its end the drive stands still and the load's last swing on a rope of 100 MN/m is below 1 µm.
  CHECK(std::abs(last(run, "sheave.y") - (2.0 - sag + 0.5 * (R - r) * turned)) < 1e-6);
  CHECK(std::abs(last(run, "sheave.theta") - 0.5 * (R + r) / 0.18 * turned) < 1e-5);
}

// (R − r)/2 of 500 kg on the drum, a quarter of that at the motor, which runs as fast as its straight characteristic gives that couple.
TEST_CASE("the gallery's hoist lifts as levers and its motor's characteristic say") {
  const MachineRun hoist("hoist");
  REQUIRE(hoist.is_complete());
  const double weight = 500.0 * k_g, couple = 0.25 * 0.03 * weight, speed = 150.0 * (1.0 - couple / 120.0);
  // It starts within 0.22 s: after 2 s e^-9 of its speed is left to gain.
  CHECK(std::abs(hoist.last("motor.omega") - speed) < 2e-4 * speed);
  CHECK(std::abs(hoist.last("drive.couple") - couple) < 5e-4 * couple);
  CHECK(std::abs((hoist.last("belt above.tension") - hoist.last("belt below.tension")) * 0.08 - couple) < 5e-4 * couple);
  CHECK(std::abs(hoist.last("right part.tension") - 0.5 * weight) < 1e-4 * weight);
  CHECK(std::abs(hoist.last("load.vy") - 0.03 * 0.25 * speed) < 2e-4);
  CHECK(hoist.events("belt below", EventKind::enters_gap).size() == 2); // as it is switched on, and as the belt swings back
}

TEST_CASE("what a wound rope cannot be is refused") {
  const auto refused = [](const std::string& fields) {
    const Written model(settings(0.1) + wheel("drum", 1.0, 1.0, "[0.0, 0.0]") +
                        body("load", "mass = 1.0; inertia = 1.0; position = [0.2, 0.0]") +
                        element("wound_rope", "rope", "stiffness = 1e5; " + fields));
    const Answer answer = steplap_does({"check", model.file.string()});
    CHECK(answer.code == 3);
    return answer.err;
  };
  CHECK(has(refused("a = 'drum'; b = 'load'; radius_a = 0.25"),
            "centres are 0.2 m apart, but a straight part of rope between them takes more than 0.25 m"));
  CHECK(has(refused("a = 'drum'; b = 'load'; pretension = 1.0; slack = 0.1"), "either 'pretension' or 'slack'"));
  CHECK(has(refused("a = 'drum'; b = { body = 'drum', point = [1.0, 0.0] }; radius_a = 0.1"), "joins a body with itself"));
}

// A bob that is thrown all the way round its drum: the angle of the rope is followed up to 172° from the reference
// pose. A load that is wound up comes to its drum.
TEST_CASE("a rope that is followed no further ends the run, and is named") {
  const auto failure_of = [](const std::string& text) {
    const Run run = run_model(Written(text).loaded());
    return run.failure ? run.failure->text : "";
  };
  const std::string round =
      failure_of(k_no_gravity + settings(4.0) + body("bob", "mass = 1.0; inertia = 0.01; position = [0.1, -3.0]; velocity = [5.0, 0.0]") +
                 element("wound_rope", "rope", "a = 'ground'; b = 'bob'; radius_a = 0.1; stiffness = 1e5; damping = 100.0"));
  CAPTURE(round);
  CHECK(has(round, "wound_rope 'rope' has turned by half a turn"));
  const std::string up = failure_of(
      settings(4.0) + wheel("drum", 30.0, 0.8, "[0.0, 5.0]") + body("load", "mass = 50.0; inertia = 1.0; position = [0.2, 4.0]") +
      element("wound_rope", "rope", "a = 'drum'; b = 'load'; radius_a = 0.2; stiffness = 2e5; damping = 500.0") +
      signal_entry("constant", "turning", "value = 3.0") +
      element("prescribed_motion", "winch", "a = 'drum'; coordinate = 'angle'; signal = 'turning'; as = 'velocity'"));
  CAPTURE(up);
  CHECK(has(up, "the load on wound_rope 'rope' has run onto its wheel"));
}
