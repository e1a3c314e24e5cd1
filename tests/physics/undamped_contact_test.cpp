// Contacts with little damping or none: what closes at the speed v opens at a time that is a closed form, loses the energy
// that the damper takes and never gains any, whatever element presses and wherever it stands.
//
// With m δ̈ = −k δ − c δ̇, ω² = k/m, ζ = c/(2 m ω) = sin φ and ω_d = ω cos φ the force ends (π − 2φ)/ω_d after closing, with the
// share e = exp(−ζ ω (π − 2φ)/ω_d) of the speed left, and the gap opens 2ζ/ω later.
#include "mbd/trust/global_error.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

struct Bounce {
  std::string element;
  double mass, frequency, damping_ratio, speed, gap; ///< frequency: ω
  Vec2 place, along;                                 ///< where the mass is at the start; unit vector away from what it hits
  double turn;                                       ///< of the direction
  bool is_guided = false;

  [[nodiscard]] double closes() const { return gap / speed; }
  [[nodiscard]] double pressed_for() const {
    const double phi = std::asin(damping_ratio);
    return (damping_ratio < 1.0 ? (std::numbers::pi - 2.0 * phi) / std::cos(phi) : 2.0) / frequency;
  }
  [[nodiscard]] double opens() const { return closes() + pressed_for() + 2.0 * damping_ratio / frequency; }
  [[nodiscard]] double lost() const { return 0.5 * mass * speed * speed * -std::expm1(-2.0 * damping_ratio * frequency * pressed_for()); }
};

std::string point(const Vec2& p) {
  std::ostringstream out;
  out.precision(17);
  out << "[" << p.x() << ", " << p.y() << "]";
  return out.str();
}

// Ropes and ties that pull are hit by what moves away.
bool pulls(const Bounce& b) { return b.element == "rope" || b.element == "tension"; }

std::string element_text(const Bounce& b) {
  std::ostringstream out;
  out.precision(17);
  const Vec2 across(-b.along.y(), b.along.x());
  const double radius = 0.02 + 5.0 * b.speed / b.frequency; // nothing presses in as deep as that
  const auto ground = [](const Vec2& p) { return "b = { body = \"ground\", at = " + point(p) + " }\n"; };
  out << "[[element]]\nname = \"stop\"\na = \"ball\"\n";
  if (b.element == "contact" || b.element == "ended") {
    out << "kind = \"unilateral_contact\"\nnormal = " << point(b.along) << "\ngap = " << b.gap << "\n" << ground(b.place - b.gap * b.along);
    if (b.element == "ended") out << "ends = [-0.5, 0.5]\n";
  } else if (b.element == "limit") {
    out << "kind = \"limit\"\nb = \"axes\"\ncoordinate = \"x\"\nlower = " << -b.gap << "\n";
  } else if (b.element == "tension" || b.element == "compression") {
    out << "kind = \"tie\"\nacts = \"" << b.element << "\"\naxis = " << point(b.along) << "\nslack = " << b.gap << "\n"
        << ground(b.place - b.along);
  } else if (b.element == "rope") {
    out << "kind = \"rope\"\nslack = " << b.gap << "\n" << ground(b.place - b.along);
  } else if (b.element == "circle") {
    out << "kind = \"circle_contact\"\nradius_a = " << radius << "\nradius_b = " << radius << "\n"
        << ground(b.place - (b.gap + 2.0 * radius) * b.along);
  } else {
    const Vec2 middle = -(b.gap + radius) * b.along;
    out << "kind = \"segment_contact\"\nradius = " << radius << "\nfrom = " << point(middle - across) << "\nto = " << point(middle + across)
        << "\n"
        << ground(b.place);
  }
  out << "stiffness = " << b.mass * b.frequency * b.frequency << "\ndamping = " << 2.0 * b.damping_ratio * b.mass * b.frequency << "\n";
  return out.str();
}

std::string text_of(const Bounce& b) {
  std::ostringstream out;
  out.precision(17);
  out << "gravity = [0.0, 0.0]\n[[body]]\nname = \"ball\"\nmass = " << b.mass << "\ninertia = " << 0.1 * b.mass
      << "\nposition = " << point(b.place) << "\nvelocity = " << point((pulls(b) ? b.speed : -b.speed) * b.along)
      << "\n[[marker]]\nname = \"axes\"\nbody = \"ground\"\nat = " << point(b.place) << "\nangle = " << b.turn << "\n";
  if (b.is_guided) out << "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"ball\"\nb = \"axes\"\n";
  out << element_text(b) << "[simulation]\nstep = 1e-3\n";
  return out.str();
}

Bounce random_bounce(std::mt19937& random) {
  const auto between = [&random](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967296.0); };
  const auto power = [&](double low, double high) { return std::pow(10.0, between(low, high)); };
  static const char* const k_elements[] = {"contact", "ended", "limit", "tension", "compression", "rope", "circle", "segment"};
  Bounce b;
  b.element = k_elements[random() % 8];
  b.mass = power(-1.0, 4.0);
  b.frequency = power(1.0, 3.5);
  b.damping_ratio = random() % 6 == 0 ? 0.0 : std::min(1.0, power(-13.0, 0.5));
  b.speed = power(-1.0, 0.7);
  b.gap = between(0.05, 0.5);
  b.turn = random() % 4 == 0 ? 0.5 * std::numbers::pi * static_cast<double>(random() % 4) : between(-3.0, 3.0);
  b.along = Vec2(std::cos(b.turn), std::sin(b.turn));
  const double away = random() % 3 == 0 ? 300.0 : 1.0;
  b.place = Vec2(between(-away, away), between(-away, away));
  b.is_guided = random() % 2 == 0;
  return b;
}

} // namespace

TEST_CASE("a contact opens when its force has ended and its gap is gone, however little is damped") {
  std::mt19937 random(24);
  const struct {
    const char* name;
    double tolerance;
  } methods[] = {{"dop853", 1e-10}, {"tsit5", 1e-8}, {"rodas5p", 1e-8}, {"dop853", 1e-6}};
  for (int i = 0; i < 400; ++i) {
    const Bounce b = random_bounce(random);
    const auto& method = methods[i % 4];
    CAPTURE(i);
    CAPTURE(b.element);
    CAPTURE(b.damping_ratio);
    CAPTURE(std::string(method.name));
    CAPTURE(b.frequency);
    CAPTURE(b.speed);
    const Run r = run(scene(text_of(b)), {method.name, method.tolerance, 1.3 * b.opens()});
    std::vector<double> opens;
    for (const Event& event : r.result.events)
      if (event.kind == EventKind::opens || event.kind == EventKind::leaves_stop || event.kind == EventKind::enters_gap)
        opens.push_back(event.t);
    REQUIRE(opens.size() == 1);
    // What the method is allowed in each step, of the contact's length; and rounding of the place, passed at the speed.
    const double left = b.speed * std::exp(-b.damping_ratio * b.frequency * b.pressed_for());
    const double rounding = 1e-14 * (1.0 + b.place.norm()) / left;
    CHECK(std::abs(opens[0] - b.opens()) < 300.0 * method.tolerance / b.frequency + rounding);
    const double energy = 0.5 * b.mass * b.speed * b.speed;
    CHECK(r.result.statistics.dissipated >= -1e-12 * energy);
    CHECK(std::abs(r.result.statistics.dissipated - b.lost()) < (1e3 * method.tolerance + 1e-11) * energy);
    CHECK(r.result.events.size() <= 3); // closes, its force ends, opens
  }
}

// What slides along what it strikes, all the time that this presses, loses μ times what the contact gives it across: by Δv_x = −μ Δv_y,
// whatever the contact's spring and damper do. No step and nothing read inside one may be worse for the end of the force,
// beyond which steps reach before they are cut. Velocities are known to their steps' tolerances, of which a bounce takes a dozen or two.
TEST_CASE("what slides along a contact while it bounces loses friction times what the contact gives it") {
  constexpr double k_steps = 30.0;
  std::mt19937_64 random(24);
  const auto between = [&](double a, double b) { return a + (b - a) * static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 40; ++i) {
    const double mass = std::pow(10.0, between(-1.0, 3.0)), frequency = std::pow(10.0, between(1.0, 3.0)), speed = between(0.2, 2.0);
    const double mu = between(0.1, 0.9), along = 3.0 * speed, damping = i % 4 == 0 ? 0.0 : between(0.0, 0.6);
    std::ostringstream out;
    out.precision(17);
    out << "gravity = [0.0, 0.0]\n[[body]]\nname = \"b\"\nmass = " << mass << "\ninertia = " << mass
        << "\nposition = [0.0, 0.1]\nvelocity = [" << along << ", " << -speed
        << "]\n[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = \"b\"\nb = \"ground\"\nnormal = [0.0, 1.0]\nstiffness = "
        << mass * frequency * frequency << "\ndamping = " << 2.0 * damping * mass * frequency
        << "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"sole\"\ncontacts = [\"floor\"]\nstatic_friction = " << mu << "\n";
    const std::string text = out.str();
    for (const char* method : {"dop853", "tsit5", "rodas5p", "auto"})
      for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        const Run bounce = run(text, {method, tolerance, 0.1 / speed + 20.0 / frequency});
        CAPTURE(i);
        CAPTURE(std::string(method));
        CAPTURE(tolerance);
        CAPTURE(damping);
        const double across = bounce.last("b.vy") + speed, lost = along - bounce.last("b.vx");
        CHECK(bounce.event_times("floor", "opens").size() == 1);
        CHECK(std::abs(lost - mu * across) <= k_steps * tolerance * along + 1e-13);
      }
  }
}

// Two masses of 1 and 2 kg between two walls with blows of 3 µs at 10 m from the origin: places are rounded to 1e-15 m, and with 1e12 N/m
// accelerations to 1e-3 m/s². Steps of 0.3 µs then know speeds to 1e-10 m/s.
namespace {

std::string masses_between_walls() {
  const auto contact = [](const std::string& name, const std::string& fields) {
    return element("unilateral_contact", name, fields + "; stiffness = 1e12");
  };
  return k_no_gravity + body("x", "mass = 1.0; inertia = 1.0; position = [2.0, 0.0]") +
         body("y", "mass = 2.0; inertia = 1.0; position = [5.0, 0.0]; velocity = [-1.0, 0.0]") + element("prismatic", "rail x", "a = 'x'") +
         element("prismatic", "rail y", "a = 'y'") +
         contact("left wall", "a = 'x'; b = { body = 'ground', at = [0.5, 0.0] }; normal = [1.0, 0.0]") +
         contact("right wall", "a = 'y'; b = { body = 'ground', at = [9.5, 0.0] }; normal = [-1.0, 0.0]") +
         contact("blow", "a = { body = 'y', point = [-0.5, 0.0] }; b = { body = 'x', point = [0.5, 0.0] }; normal = [1.0, 0.0]");
}

} // namespace

TEST_CASE("stiff contacts at tolerances below rounding: steps no shorter than rounding allows, and a known error") {
  const auto system = compile(scene(masses_between_walls()));
  for (const std::string method : {"auto", "dop853", "tsit5", "rodas5p"}) {
    CAPTURE(method);
    const auto run_at = [&](double tolerance) {
      SimulationOptions o = options({method, tolerance, 30.0});
      o.has_extremes = true;
      o.output_step = 1.0;
      return std::pair(o, simulate(*system, system->initial_state(), o));
    };
    const long steps_at_floor = run_at(1e-12).second.statistics.steps;
    CHECK(run_at(1e-9).second.statistics.rounded_tolerance == 0.0);
    for (const double tolerance : {1e-11, 1e-12, 1e-13}) {
      CAPTURE(tolerance);
      const auto [o, run] = run_at(tolerance);
      CHECK(run.statistics.steps < 3 * steps_at_floor);
      const GlobalErrorEstimate estimate = estimate_global_error(*system, system->initial_state(), o, run);
      CHECK(estimate.reason_unknown == "");
      // Speeds are known to 1e-10 m/s, and blows pass that on without magnifying it: 3e-9 m in 30 s, which twelve blows add up.
      CHECK(estimate.error.of(ErrorKind::position).value < 1e-6);
    }
    const RunStatistics finest = run_at(1e-14).second.statistics;
    CHECK(finest.steps < 3 * steps_at_floor);
    CHECK(finest.rounded_tolerance > 1e-13);
  }
}
