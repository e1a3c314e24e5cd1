// Loads that constraints can share in more than one way: a group of sticking elements holds until none of the
// sharings is admissible any more, and what is reported obeys equilibrium.
#include "tests/physics/scene.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

const char* const k_methods[] = {"rk4", "tsit5", "dop853", "rodas5p", "auto"};

Settings settings(const std::string& integrator, double end, double output_step = 0.0) {
  return {integrator, integrator == "rk4" ? 1e-3 : 1e-10, end, output_step};
}

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// 0 to rate·10 s in 10 s.
std::string ramp(double rate) {
  return "[[signal]]\nname = \"ramp\"\nkind = \"trapezoid\"\npeak = " + number(10.0 * rate) +
         "\nrise = 10.0\nfall = 0.0\nduration = 100.0\n";
}

std::string push(const std::string& body, const std::string& what = "force_x") {
  return "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"" + body + "\"\n" + what + " = \"ramp\"\n";
}

// A foot under `at` that bears `weight` and sticks for itself.
std::string foot(const std::string& name, const std::string& body, double x, double weight, double mu_s, double mu_k) {
  return "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + name + "\"\na = { body = \"" + body + "\", at = [" + number(x) +
         ", 0.0] }\nb = { body = \"ground\", at = [" + number(x) +
         ", 0.0] }\nstiffness = 1e5\ndamping = 400.0\npreload = " + number(weight) + "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"" +
         name + " friction\"\ncontacts = [\"" + name + "\"]\nstatic_friction = " + number(mu_s) + "\nkinetic_friction = " + number(mu_k) +
         "\n";
}

std::string body(const std::string& name, double mass, double x, double y = 0.0) {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + number(mass) + "\ninertia = 1.0\nposition = [" + number(x) + ", " + number(y) +
         "]\n";
}

std::string box_on_two_feet(double mu_s1, double mu_k1, double mu_s2, double mu_k2) {
  return ramp(12.0) + body("box", 2.0, 0.0) + foot("rear", "box", -1.0, 9.81, mu_s1, mu_k1) +
         foot("front", "box", 1.0, 9.81, mu_s2, mu_k2) + push("box");
}

// Bounds may be passed by 1e-13 of themselves, and times are resolved to a few roundings.
constexpr double k_onset = 3e-13;

void slip_at(const Run& r, std::size_t count, double onset) {
  std::size_t found = 0;
  for (const Event& event : r.result.events) {
    if (!is_slip(event.kind)) continue;
    ++found;
    CHECK(std::abs(event.t - onset) < k_onset);
  }
  CHECK(found == count);
  CHECK(r.result.events.size() == count);
}

} // namespace

TEST_CASE("shared loads: two feet of unequal capacity let go together, when the sum is passed") {
  const double onset = (0.3 + 0.5) * 9.81 / 12.0;
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run r = run(box_on_two_feet(0.3, 0.3, 0.5, 0.5), settings(method, 1.0, 0.01));
    slip_at(r, 2, onset);
    // (F − Σ μ N)/m after it: a cubic.
    CHECK(std::abs(r.last("box.x") - 12.0 * std::pow(1.0 - onset, 3) / 12.0) < 1e-12);
    for (std::size_t i = 0; i < r.times().size() && r.times()[i] < onset; ++i) {
      const double force = 12.0 * r.times()[i], rear = r.series("rear friction.friction")[i],
                   front = r.series("front friction.friction")[i];
      CHECK(std::abs(rear + 0.3 / 0.8 * force) < 1e-12); // each in proportion to its capacity
      CHECK(std::abs(front + 0.5 / 0.8 * force) < 1e-12);
    }
  }
}

TEST_CASE("shared loads: what slips has its kinetic coefficient, what holds the static one, until the sum is passed") {
  const double onset = (0.3 + 0.5) * 9.81 / 12.0, end = onset + 0.2, kinetic = (0.2 + 0.35) * 9.81;
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run r = run(box_on_two_feet(0.3, 0.2, 0.5, 0.35), settings(method, end));
    slip_at(r, 2, onset);
    const double left = end - onset, excess = 0.8 * 9.81 - kinetic;
    CHECK(std::abs(r.last("box.x") - (0.5 * excess * left * left + 2.0 * left * left * left) / 2.0) < 1e-11);
  }
}

TEST_CASE("shared loads: the group comes to rest, holds again and lets go the other way, at its exact instants") {
  // 12 sin(2πt/2 s): at the sum of capacities after asin(0.654)/π s; the second onset after it has come to rest.
  const std::string shake =
      "[[signal]]\nname = \"ramp\"\nkind = \"harmonics\"\namplitudes = [12.0]\nfrequencies = [0.5]\nphases = [\"-90 deg\"]\n";
  std::string text = box_on_two_feet(0.3, 0.3, 0.5, 0.5);
  const std::size_t begin = text.find("[[signal]]"), stop = text.find("[[body]]");
  text.replace(begin, stop - begin, shake);
  const double bound = 0.8 * 9.81, pi = 3.14159265358979323846, onset = std::asin(bound / 12.0) / pi;
  for (const char* method : {"rk4", "dop853"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, settings(method, 1.9));
    const std::vector<double> slips = r.event_times("front friction", "slips forward"), rests = r.event_times("front friction", "sticks"),
                              back = r.event_times("front friction", "slips backward");
    REQUIRE(slips.size() == 1);
    REQUIRE(rests.size() >= 1);
    REQUIRE(back.size() == 1);
    CHECK(std::abs(slips[0] - onset) < k_onset);
    CHECK(std::abs(back[0] - 1.0 - onset) < k_onset);
    CHECK(r.event_times("rear friction") == r.event_times("front friction"));
    // Momentum: ∫ (12 sin πt − bound) dt from the onset to rest is nothing.
    const double t = rests[0], gained = 12.0 / pi * (std::cos(pi * onset) - std::cos(pi * t)) - bound * (t - onset);
    CHECK(std::abs(gained) < 1e-9);
  }
}

TEST_CASE("shared loads: a chain of unequal blocks to and fro: all of it slips, rests and slips back at the same instants") {
  std::string text = "[[signal]]\nname = \"still\"\nkind = \"constant\"\nvalue = 0.0\n";
  double bound = 0.0;
  for (int i = 1; i <= 5; ++i) {
    const std::string n = "block " + std::to_string(i);
    const double mass = 0.5 + 0.25 * i, mu = 0.1 + 0.07 * (i * 3 % 5);
    bound += mu * mass * 9.81;
    text += body(n, mass, 2.0 * i) + foot("sole " + std::to_string(i), n, 2.0 * i, mass * 9.81, mu, mu);
    text += "[[element]]\nkind = \"prescribed_motion\"\nname = \"upright " + n + "\"\na = \"" + n +
            "\"\ncoordinate = \"angle\"\nsignal = \"still\"\n";
    if (i > 1)
      text += "[[element]]\nkind = \"distance\"\nname = \"rod " + std::to_string(i) + "\"\na = \"block " + std::to_string(i - 1) +
              "\"\nb = \"" + n + "\"\n";
  }
  text += "[[signal]]\nname = \"ramp\"\nkind = \"harmonics\"\namplitudes = [" + number(1.2 * bound) +
          "]\nfrequencies = [0.5]\nphases = [\"-90 deg\"]\n" + push("block 2");
  // Something that moves meanwhile, so that steps stay shorter than the load's period.
  text += body("bob", 1.0, -5.0, 0.1) + "[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = \"bob\"\naxis = [0.0, 1.0]\n"
                                        "stiffness = 400.0\n";
  const double pi = 3.14159265358979323846, onset = std::asin(1.0 / 1.2) / pi;
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run r = run(text, settings(method, 1.6));
    CHECK(r.result.events.size() == 15); // slip, rest, slip back, five times
    const std::vector<double> first = r.event_times("sole 1 friction");
    REQUIRE(first.size() == 3);
    for (int i = 2; i <= 5; ++i) {
      const std::vector<double> other = r.event_times("sole " + std::to_string(i) + " friction");
      REQUIRE(other.size() == 3);
      for (int e = 0; e < 3; ++e) CHECK(std::abs(other[e] - first[e]) < 1e-14); // the spacing of times
    }
    CHECK(std::abs(first[0] - onset) < k_onset);
    CHECK(std::abs(first[2] - 1.0 - onset) < k_onset);
  }
}

TEST_CASE("shared loads: friction beside a joint that holds all the same bears nothing and never slips") {
  for (const char* joint : {"weld", "distance", "prismatic"}) {
    CAPTURE(joint);
    std::string text = ramp(100.0) + body("box", 2.0, 0.0) + foot("sole", "box", 0.0, 19.62, 0.1, 0.1) + push("box");
    text += std::string("[[element]]\nkind = \"") + joint + "\"\nname = \"anchor\"\na = \"box\"\nb = { body = \"ground\", at = [" +
            (std::string(joint) == "weld" ? "0.0" : "-3.0") + ", 0.0] }\n";
    if (std::string(joint) == "prismatic") text += "axis = [0.0, 1.0]\n";
    const Run r = run(text, settings("dop853", 1.0, 0.1)); // 100 N, of which the foot could bear 2 N
    CHECK(r.result.events.empty());
    for (const double f : r.series("sole friction.friction")) CHECK(std::abs(f) < 1e-12);
  }
}

TEST_CASE("shared loads: a flat toggle is redundant only where it is flat, and holds there by both its ends") {
  // block a – rod – knee – rod – block b in one line; off the line the push could not reach b.
  const std::string still = "[[signal]]\nname = \"still\"\nkind = \"constant\"\nvalue = 0.0\n";
  std::string text = ramp(12.0) + still + body("a", 1.0, 0.0) + body("knee", 1.0, 1.0) + body("b", 1.0, 2.0) +
                     foot("sole a", "a", 0.0, 9.81, 0.3, 0.3) + foot("sole b", "b", 2.0, 9.81, 0.5, 0.5) + push("a");
  for (const char* name : {"a", "knee", "b"})
    text += std::string("[[element]]\nkind = \"prescribed_motion\"\nname = \"upright ") + name + "\"\na = \"" + name +
            "\"\ncoordinate = \"angle\"\nsignal = \"still\"\n";
  text += "[[element]]\nkind = \"distance\"\nname = \"rod a\"\na = \"a\"\nb = \"knee\"\n";
  text += "[[element]]\nkind = \"distance\"\nname = \"rod b\"\na = \"knee\"\nb = \"b\"\n";
  text += "[[element]]\nkind = \"spring_damper\"\nname = \"support\"\na = \"knee\"\naxis = [0.0, 1.0]\nstiffness = 1e4\n"
          "preload = 9.81\n";
  const double onset = 0.8 * 9.81 / 12.0;
  for (const char* method : {"rk4", "dop853"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, settings(method, onset + 0.01, 0.05));
    REQUIRE(r.result.events.size() >= 2);
    CHECK(std::abs(r.result.events[0].t - onset) < k_onset);
    CHECK(std::abs(r.result.events[1].t - onset) < k_onset);
    for (std::size_t i = 0; i < r.times().size() && r.times()[i] < onset; ++i)
      CHECK(std::abs(r.series("rod a.force")[i] - r.series("rod b.force")[i]) < 1e-12);
  }
}

TEST_CASE("shared loads: friction held by a loop that moves: null vectors turn with it, and nothing slips") {
  // A parallelogram keeps its coupler's angle; friction of 1 N m about the same angle has nothing to hold, whatever
  // couple pulls at the coupler. Swings between the flat positions.
  std::string text = ramp(50.0) + body("coupler", 2.0, 0.5 + std::cos(1.5), std::sin(1.5)) + push("coupler", "torque");
  for (const double x : {0.0, 1.0}) {
    const std::string n = x == 0.0 ? "first" : "second";
    text += "[[body]]\nname = \"" + n + "\"\nmass = 1.0\ninertia = 0.1\nposition = [" + number(x + 0.5 * std::cos(1.5)) + ", " +
            number(0.5 * std::sin(1.5)) + "]\nangle = 1.5\nangular_velocity = 0.1\n";
    text += "[[element]]\nkind = \"revolute\"\nname = \"pin " + n + "\"\na = { body = \"" + n + "\", at = [" + number(x) +
            ", 0.0] }\nb = { body = \"ground\", at = [" + number(x) + ", 0.0] }\n";
    const std::string head = "at = [" + number(x + std::cos(1.5)) + ", " + number(std::sin(1.5)) + "] }\n";
    text += "[[element]]\nkind = \"revolute\"\nname = \"head " + n + "\"\na = { body = \"" + n + "\", " + head +
            "b = { body = \"coupler\", " + head;
  }
  text += "[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = \"coupler\"\naxis = [1.0, 0.0]\nstiffness = 200.0\n";
  text += "[[element]]\nkind = \"joint_friction\"\nname = \"grip\"\na = \"coupler\"\nholds = 1.0\n";
  const Run r = run(text, settings("dop853", 1.0, 0.05));
  CHECK(r.result.events.empty());
  CHECK(std::abs(r.last("first.theta") - 1.5) > 0.01); // it has moved
  for (const double moment : r.series("grip.friction")) CHECK(std::abs(moment) < 1e-9);
  for (const double angle : r.series("coupler.theta")) CHECK(std::abs(angle) < 1e-11);
}

namespace {

// A limb held by patches at −1 m and 1 m: two interfaces of one joint, or two joints; the yokes on rails or fixed.
std::string limb_on_two_patches(bool is_one_joint, bool is_free, const std::string& load) {
  std::string text = ramp(4e6) + "[[body]]\nname = \"limb\"\nmass = 1000.0\ninertia = 700.0\n";
  text += "[[body]]\nname = \"yokes\"\nmass = 5000.0\ninertia = 9000.0\n";
  if (!is_free) text.insert(text.size() - std::string("mass = 5000.0\ninertia = 9000.0\n").size(), "fixed = true\n");
  for (const int side : {-1, 1}) {
    const std::string joint = is_one_joint ? "joint" : side < 0 ? "joint left" : "joint right";
    if (!is_one_joint || side < 0)
      text += "[[element]]\nkind = \"step_lap_joint\"\nname = \"" + joint + "\"\nlimb = \"limb\"\nactive_part = \"yokes\"\n";
    const double x = side;
    const auto square = [&](double half) {
      return "[[" + number(x - half) + ", " + number(-half) + "], [" + number(x + half) + ", " + number(-half) + "], [" + number(x + half) +
             ", " + number(half) + "], [" + number(x - half) + ", " + number(half) + "]]";
    };
    text += std::string("[[element]]\nkind = \"step_lap_interface\"\nname = \"corner ") + (side < 0 ? "left" : "right") + "\"\njoint = \"" +
            joint + "\"\nyoke = " + square(0.9) + "\nlimb = " + square(side < 0 ? 0.3 : 0.2) +
            "\ncount = 100\npressure = 1e5\nstatic_friction = 0.25\n";
  }
  return text + load;
}

} // namespace

TEST_CASE("shared loads: two joints side by side let go as one joint with both areas does") {
  const std::string twist = push("limb", "torque"),
                    eccentric =
                        push("limb", "force_x") + "[[element]]\nkind = \"load\"\nname = \"turn\"\nat = \"limb\"\ntorque = \"ramp\"\n";
  for (const bool is_free : {false, true})
    for (const std::string& load : {twist, eccentric}) {
      if (steplap::testing::k_is_sanitized && is_free == (load == twist)) continue; // each once
      CAPTURE(is_free);
      const Run one = run(limb_on_two_patches(true, is_free, load), settings("dop853", 0.6));
      const Run two = run(limb_on_two_patches(false, is_free, load), settings("dop853", 0.6));
      REQUIRE(one.result.events.size() >= 1);
      REQUIRE(two.result.events.size() >= 2);
      const double onset = one.result.events[0].t;
      CHECK(onset > 0.1);
      // Cutting planes of curved sets: bounds from both sides meet to 1e-12 or so.
      CHECK(std::abs(two.result.events[0].t / onset - 1.0) < 1e-11);
      CHECK(std::abs(two.result.events[1].t / onset - 1.0) < 1e-11);
      // Each joint regularises its own onset: 1e-7 s of a motion of a fiftieth of a second. (Later one of the two comes
      // apart, which of the one joint only an interface does.)
      const Settings sliding = settings("dop853", onset + 0.02);
      const Run one_slides = run(limb_on_two_patches(true, is_free, load), sliding),
                two_slide = run(limb_on_two_patches(false, is_free, load), sliding);
      CHECK(std::abs(one_slides.last("limb.theta")) > 1e-4);
      for (const char* channel : {"limb.x", "limb.y", "limb.theta"})
        CHECK(std::abs(two_slide.last(channel) - one_slides.last(channel)) < 1e-6);
    }
}

TEST_CASE("shared loads: a joint beside a weld bears nothing, merged or not") {
  for (const bool is_free : {false, true}) {
    const std::string load = push("limb", "torque") + "[[element]]\nkind = \"weld\"\nname = \"weld\"\na = \"limb\"\nb = \"yokes\"\n";
    const Run r = run(limb_on_two_patches(true, is_free, load), settings("dop853", 5.0, 0.5));
    CHECK(r.result.events.empty());
    for (const double m : r.series("joint.m")) CHECK(std::abs(m) < 1e-6); // of 2e7 N m
    const double limb_share = is_free ? 9000.0 / 9700.0 : 1.0;            // of the torque on the limb: what does not turn it
    CHECK(std::abs(std::abs(r.last("weld.couple")) / (limb_share * 2e7) - 1.0) < 1e-9);
  }
}

TEST_CASE("shared loads: of redundant joints the least reactions are reported, and they obey equilibrium") {
  // A beam of 10 kg on three pins in a row: vertical thirds, as the weight is central; no horizontal load.
  std::string text = "[[body]]\nname = \"beam\"\nmass = 10.0\ninertia = 5.0\n";
  for (const std::string x : {"-1", "0", "1"})
    text += "[[element]]\nkind = \"revolute\"\nname = \"pin " + x + "\"\na = { body = \"beam\", at = [" + x +
            ".0, 0.0] }\nb = { body = \"ground\", at = [" + x + ".0, 0.0] }\n";
  text += "[[element]]\nkind = \"load\"\nname = \"couple\"\nat = \"beam\"\ncouple = 7.0\n";
  const Run r = run(text, settings("dop853", 0.1));
  const double left = r.last("pin -1.force_y"), middle = r.last("pin 0.force_y"), right = r.last("pin 1.force_y");
  CHECK(std::abs(left + middle + right - 98.1) < 1e-10);
  CHECK(std::abs(right - left + 7.0) < 1e-10); // the outer pins take the couple
  // Least Σ A_rr λ²: A_rr = 1/m + x²/J, so that what the vector (1, −2, 1) does has no part in λ.
  const double outer = 1.0 / 10.0 + 1.0 / 5.0, inner = 1.0 / 10.0;
  CHECK(std::abs(outer * left - 2.0 * inner * middle + outer * right) < 1e-10);
  for (const char* pin : {"pin -1.force_x", "pin 0.force_x", "pin 1.force_x"}) CHECK(std::abs(r.last(pin)) < 1e-10);
}
