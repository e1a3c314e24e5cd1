// Machines that have a rest by construction, at all scales: it is found, it is stationary, and where there is a closed form it
// is right.
#include "mbd/rest/settling.h"
#include "tests/physics/rest_scene.h"
#include "tests/random/random_number.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string box(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return "outline = [[" + number(-x) + ", " + number(-y) + "], [" + number(x) + ", " + number(-y) + "], [" + number(x) + ", " + number(y) +
         "], [" + number(-x) + ", " + number(y) + "]]";
}
std::string plate(double mass, double width, double height) {
  return "mass = " + number(mass) + "; inertia = " + number(mass * (width * width + height * height) / 12.0) + "; " + box(width, height);
}

// A run from there stays there, for as long as a fall over a part of the length takes.
void check_stationary(const Found& found, double length) {
  const RunResult stays = simulate(*found.system, found.rest.state, options({"auto", 1e-8, std::sqrt(length / k_g)}));
  for (std::size_t i = 3; i < found.rest.state.q.size(); ++i)
    CHECK(std::abs(stays.final_state.q[i] - found.rest.state.q[i]) < 1e-6 * (i % 3 < 2 ? length : 1.0));
}

} // namespace

// A mass on a vertical guide falls from anywhere onto a thin plank, which turns until its stop bears: with the foot's place x
// beside the pivot and d above the middle line, half the thickness less what it gives, the foot presses with N = m g/cos θ,
// and the stop gives way by N (x/cos θ + d tan θ)/k.
TEST_CASE("a guided mass comes to rest on a seesaw of any thinness and size") {
  random::RandomNumber random(24);
  for (int i = 0; i < 120; ++i) {
    CAPTURE(i);
    const double s = std::pow(10.0, random.between(-3.0, 3.0)), half = s * random.between(1.0, 3.0),
                 thick = half * std::pow(10.0, random.between(-4.0, -1.0));
    const double m = random.between(20.0, 100.0), mass = random.between(10.0, 60.0), reach = half * random.between(0.4, 0.9);
    const double tilt = random.between(0.02, 0.3), lower = -random.between(0.1, 0.4), high = half * random.between(0.3, 2.0);
    const double k = m * k_g / (0.02 * thick), stop = m * k_g * half / 1e-4;
    const std::string text =
        body("plank", "position = " + point(0.0, 0.0) + "; angle = " + number(tilt) + "; " + plate(mass, 2.0 * half, thick)) +
        element("revolute", "pivot", "a = 'plank'; b = 'ground'") +
        element("limit", "stops",
                "a = 'plank'; coordinate = 'angle'; upper = 0.0; lower = " + number(lower - tilt) + "; stiffness = " + number(stop)) +
        body("jumper", "position = " + point(reach, reach * std::tan(tilt) + high + 0.3 * half) + "; " + plate(m, 0.2 * half, 0.6 * half)) +
        element("prismatic", "guide", "a = 'jumper'; axis = [0.0, 1.0]") +
        element("segment_contact", "feet",
                "a = { body = 'jumper', point = " + point(0.0, -0.3 * half) + " }; b = 'plank'; from = " + point(-half, 0.0) +
                    "; to = " + point(half, 0.0) + "; thickness = " + number(thick) + "; stiffness = " + number(k));
    const Found found = settle(text);
    const double theta = found.q(1, 2);
    const double pressed = m * k_g / std::cos(theta), arm = reach / std::cos(theta) + (0.5 * thick - pressed / k) * std::tan(theta);
    CHECK(std::abs(lower - theta - pressed * arm / stop) < 1e-10 + 1e-6 * pressed * arm / stop);
    const double foot = found.q(2, 1) - 0.3 * half; // over the plank's middle line by half its thickness, less what it gives
    CHECK(std::abs((foot - reach * std::tan(theta)) * std::cos(theta) - 0.5 * thick + pressed / k) < 1e-9 * half);
    CHECK(found.rest.residual < 1e-6 * k_g);
    if (i % 12 == 0) check_stationary(found, 0.01 * half);
  }
}

// What is dropped on a thin plank on trestles, or on a block, comes to lie on it: its faces lie on each other, all give way
// by the weight above over stiffness and width.
TEST_CASE("blocks dropped on blocks and on planks lie on them") {
  random::RandomNumber random(25);
  for (int i = 0; i < 120; ++i) {
    CAPTURE(i);
    const double s = std::pow(10.0, random.between(-3.0, 3.0)), w = s * random.between(1.0, 3.0),
                 h = w * std::pow(10.0, random.between(-2.0, 0.0));
    const double v = w * random.between(0.2, 0.6), u = v * random.between(0.4, 1.0), gap = w * random.between(0.1, 2.0);
    const double off = (0.5 * w - 0.5 * v) * random.between(-0.5, 0.5), tilt = random.between(-0.3, 0.3);
    const double below = random.between(20.0, 60.0), above = random.between(5.0, 20.0), k = (below + above) * k_g / (v * 1e-3 * h);
    const std::string law = "; stiffness = " + number(k) + "; dissipation = 1.0; static_friction = 0.8";
    const Found found = settle(
        body("lower", "position = " + point(0.0, 0.5 * h) + "; " + plate(below, w, h)) +
        body("upper", "position = " + point(off, h + gap + v) + "; angle = " + number(tilt) + "; " + plate(above, v, u)) +
        element("polygon_contact", "floor", "a = 'lower'" + law) + element("polygon_contact", "faces", "a = 'upper'; b = 'lower'" + law));
    CHECK(std::abs(std::remainder(found.q(2, 2) - found.q(1, 2), 0.5 * k_pi)) < 1e-3);
    const double first = (below + above) * k_g / (k * w), second = above * k_g / (k * v);
    if (std::abs(found.q(2, 2)) < 0.1 && std::abs(off) < 0.01 * w) // centred: nothing leans
      CHECK(std::abs(found.q(2, 1) - h - 0.5 * u + first + second) < 1e-2 * (first + second));
    CHECK(found.q(2, 1) > h);
    CHECK(found.rest.residual < 1e-6 * k_g);
    if (i % 12 == 0) check_stationary(found, 0.01 * h);
  }
}

// Rods between nodes on a drum, the same pull at both ends: rods let no node press but together with its neighbours.
TEST_CASE("chains over drums of any count and size rest") {
  random::RandomNumber random(26);
  for (int n = 4; n < 13; ++n) {
    const double s = std::pow(10.0, random.between(-3.0, 3.0)), radius = 0.2 * s, first = random.between(0.05, 0.4),
                 pull = random.between(20.0, 200.0);
    const double k = 1e4 * pull / radius, friction = random.between(0.1, 0.5);
    CAPTURE(n);
    CAPTURE(s);
    std::string text = k_no_gravity + k_head + signal_entry("constant", "zero", "value = 0.0");
    for (int j = 0; j < n; ++j) {
      const std::string id = std::to_string(j);
      const double at = first + (k_pi - 2.0 * first) * j / (n - 1);
      text += body("n" + id, "mass = 0.02; inertia = " + number(1e-6 * s * s) +
                                 "; position = " + point(radius * std::cos(at), radius * std::sin(at))) +
              element("circle_contact", "c" + id,
                      "a = 'n" + id + "'; radius_a = " + number(0.025 * radius) + "; radius_b = " + number(0.975 * radius) +
                          "; stiffness = " + number(k) + "; damping = " + number(0.1 * std::sqrt(k))) +
              element("coulomb_stick", "f" + id, "contacts = ['c" + id + "']; static_friction = " + number(friction)) +
              element("prescribed_motion", "r" + id,
                      "a = 'n" + id + "'; coordinate = 'angle'; signal = 'zero'; as = 'position'; zero = 'reference'");
      if (j > 0) text += element("distance", "l" + id, "a = 'n" + std::to_string(j - 1) + "'; b = 'n" + id + "'");
    }
    for (const int j : {0, n - 1})
      text += element("load", "p" + std::to_string(j), "at = 'n" + std::to_string(j) + "'; force = " + point(0.0, -pull));
    const Found found = settle(scene(text));
    // What the drum gives way to: the largest pull over the stiffness, a few times where nodes share it.
    CHECK(found.rest.residual < 1e-6 * pull / 0.02);
    for (const FrictionMargin& margin : found.rest.margins) CHECK(margin.used <= 1.0 + 1e-9);
    if (found.rest.is_settled || !found.rest.slid.empty()) CHECK(found.rest.depends_on_path);
  }
}

// A load on a slack rope falls until that holds it: as far below as the rope is long.
TEST_CASE("a load falls into its rope") {
  random::RandomNumber random(27);
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const double s = std::pow(10.0, random.between(-3.0, 3.0)), length = s * random.between(1.0, 3.0), at = random.between(-1.2, 1.2),
                 out = random.between(0.2, 0.95);
    const Found found =
        settle(body("load", "mass = 10; inertia = " + number(0.1 * s * s) +
                                "; position = " + point(out * length * std::sin(at), -out * length * std::cos(at))) +
               element("rope", "rope",
                       "a = 'load'; b = 'ground'; length = " + number(length) + "; stiffness = " + number(10.0 * k_g / (1e-6 * length))));
    CHECK(std::abs(found.q(1, 0)) < 1e-9 * length);
    CHECK(std::abs(found.q(1, 1) + length * (1.0 + 1e-6)) < 1e-9 * length);
  }
}

// Time stands still while a machine settles: what a load that changes presses against a spring is its value at that time over the
// stiffness, and not its mean over the steps by which the machine creeps there.
TEST_CASE("what settles under a load that changes does so under its value") {
  random::RandomNumber random(28);
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const double mass = random.between(1.0, 50.0), k = random.decades(2.0, 6.0), amplitude = random.decades(0.0, 3.0);
    const double frequency = random.decades(-2.0, 3.0), phase = random.between(0.0, 2.0 * k_pi);
    const auto system = compile(scene(
        k_no_gravity + k_head + body("block", "mass = " + number(mass) + "; inertia = 1.0") +
        element("prismatic", "guide", "a = 'block'; axis = [1.0, 0.0]") +
        element("spring_damper", "spring", "a = 'block'; b = 'ground'; axis = [1.0, 0.0]; free_length = 0.0; stiffness = " + number(k)) +
        signal_entry("harmonics", "push",
                     "amplitudes = [" + number(amplitude) + "]; frequencies = [" + number(frequency) + "]; phases = [" + number(phase) +
                         "]") +
        element("load", "pushed", "at = 'block'; force_x = 'push'")));
    const Settling settling = settle_in_time(*system, system->initial_state());
    REQUIRE(settling.rest);
    CHECK(std::abs(settling.rest->q[3] - amplitude * std::cos(phase) / k) <
          1e-6 * amplitude / k); // it stops at 1e-9 of the load's acceleration
  }
}
