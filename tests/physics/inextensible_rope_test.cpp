// Inextensible ropes: taut and slack, caught by blows without restitution, against closed forms.
//
// Tolerances: runs at 1e-11 over some hundred steps leave 1e-9 of values near 1; what a blow does is exact to rounding for
// the velocities that the run brings to it.
#include "mbd/rest/equilibrium.h"
#include "mbd/rest/modes.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;
constexpr const char* k_ceiling = "b = { body = \"ground\", at = [0.0, 0.0] }";

Run run_in(const std::string& text, Coordinates coordinates, double end, const std::string& method = "dop853") {
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  SimulationOptions o = options({method, 1e-11, end});
  o.coordinates = coordinates;
  r.result = simulate(*r.system, r.system->initial_state(), o);
  return r;
}

std::string rope(const std::string& name, const std::string& fields) { return element("rope", name, fields + "; inextensible = true"); }

std::string point_mass(const std::string& name, double mass, double x, double y, double vx, double vy) {
  const auto pair = [](double u, double v) { return "[" + std::to_string(u) + ", " + std::to_string(v) + "]"; };
  return body(name, "mass = " + std::to_string(mass) + "; inertia = 0.1; position = " + pair(x, y) + "; velocity = " + pair(vx, vy));
}

struct Rest {
  std::unique_ptr<System> system;
  Equilibrium found;
};

std::string detail_of(const Run& r, const std::string& name, EventKind kind) {
  for (const Event& event : r.result.events)
    if (event.element == name && event.kind == kind) return event.detail;
  return "none";
}

} // namespace

TEST_CASE("a mass that falls into its rope stops dead and hangs there") {
  const double s = 0.5, m = 2.0, v = std::sqrt(2.0 * k_g * s);
  const std::string text =
      point_mass("mass", m, 0.0, -1.0, 0.0, 0.0) + rope("line", std::string("a = \"mass\"; slack = 0.5; ") + k_ceiling);
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint})
    for (const char* method : {"dop853", "rodas5p", "tsit5", "auto"}) {
      CAPTURE(std::string(method));
      const Run r = run_in(text, coordinates, 1.0, method);
      REQUIRE(r.event_times("line").size() == 1);
      CHECK(std::abs(r.event_times("line", "closes its gap").at(0) - std::sqrt(2.0 * s / k_g)) < 1e-9);
      CHECK(std::abs(r.last("mass.y") + 1.5) < 1e-11); // its row holds
      CHECK(std::abs(r.last("mass.vy")) < 1e-11);
      CHECK(std::abs(r.last("line.tension") - m * k_g) < 1e-9);
      CHECK(std::abs(r.last("line.impulse") - m * v) < 1e-8);
      CHECK(std::abs(r.result.statistics.dissipated - 0.5 * m * v * v) < 1e-8);
      CHECK(r.result.statistics.energy_residual < 1e-9);
      CHECK(detail_of(r, "line", EventKind::closes_gap) == "with 6.264 N s, 9.81 J lost");
    }
}

// From the bottom with v₀² between 2 g L and 5 g L it goes slack φ above the horizontal, sin φ = (v₀²/(g L) − 2)/3, with
// v² = g L sin φ; |r|² = L² + ¼ g²t⁴ − g v cos φ t³ along the parabola: caught after 4 v cos φ/g.
TEST_CASE("a pendulum goes slack above the horizontal, flies its parabola and is caught") {
  const double length = 1.5, m = 0.7, v0 = std::sqrt(3.2 * k_g * length), phi = std::asin(0.4);
  const double v = std::sqrt(k_g * length * 0.4), flight = 4.0 * v * std::cos(phi) / k_g;
  const std::string text = body("bob", "mass = 0.7; inertia = 0.01; position = [0.0, -1.5]; velocity = [" + std::to_string(v0) + ", 0.0]") +
                           rope("line", std::string("a = \"bob\"; ") + k_ceiling);
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
    const Run r = run_in(text, coordinates, 1.6);
    const std::vector<double> slack = r.event_times("line", "enters its gap"), taut = r.event_times("line", "closes its gap");
    REQUIRE(slack.size() >= 1);
    REQUIRE(taut.size() >= 1);
    // v₀ has six digits: relative 2e-7 of it, and the angle is as sensitive to it as 1/3 · 6.4.
    CHECK(std::abs(taut[0] - slack[0] - flight) < 1e-6);
    const Run at_slack = run_in(text, coordinates, slack[0]);
    CHECK(std::abs(at_slack.last("bob.y") - length * 0.4) < 2e-6);
    CHECK(std::abs(at_slack.last("bob.x") - length * std::cos(phi)) < 2e-6);
    // Behind the blow only the velocity across the rope is left.
    const double x = length * std::cos(phi) - v * std::sin(phi) * flight,
                 y = length * std::sin(phi) + v * std::cos(phi) * flight - 0.5 * k_g * flight * flight;
    const double vx = -v * std::sin(phi), vy = v * std::cos(phi) - k_g * flight, radial = (x * vx + y * vy) / length;
    const Run at_catch = run_in(text, coordinates, taut[0] + 1e-9); // 1e-9 s of some 10 m/s² change nothing that is asked for
    CHECK(std::abs(at_catch.last("line.impulse") - m * radial) < 1e-5);
    CHECK(std::abs(std::hypot(at_catch.last("bob.vx"), at_catch.last("bob.vy")) - std::abs(x * vy - y * vx) / length) < 1e-5);
    CHECK(std::abs(at_catch.result.statistics.dissipated - 0.5 * m * radial * radial) < 1e-5);
    CHECK(r.result.statistics.energy_residual < 1e-8);
  }
}

TEST_CASE("behind the blow two masses fly on together, less the energy of their relative motion") {
  const double m1 = 3.0, m2 = 1.0, v = 2.0;
  const std::string text = k_no_gravity + point_mass("heavy", m1, 0.0, 0.0, 0.0, 0.0) + point_mass("light", m2, 0.5, 0.0, v, 0.0) +
                           rope("line", "a = \"heavy\"; b = \"light\"; length = 1.5");
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
    const Run r = run_in(text, coordinates, 1.0);
    CHECK(std::abs(r.event_times("line", "closes its gap").at(0) - 0.5) < 1e-10);
    CHECK(std::abs(r.last("heavy.vx") - 0.5) < 1e-11);
    CHECK(std::abs(r.last("light.vx") - 0.5) < 1e-11);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * m1 * m2 / (m1 + m2) * v * v) < 1e-10);
    CHECK(std::abs(r.last("line.tension")) < 1e-9);
  }
}

// A rod on a pin, whose free end is caught: J ω² remains of nothing, since the rope holds the one freedom it has. With the pin on a
// slide the momentum along it stays.
TEST_CASE("a blow passes on through joints, in either coordinates") {
  const auto text = k_no_gravity + body("cart", "mass = 4; inertia = 1; position = [0.0, 0.0]") +
                    body("rod", "mass = 1; inertia = 0.2; position = [0.0, -1.0]; velocity = [2.0, 0.0]; angular_velocity = 2.0") +
                    element("prismatic", "rail", "a = \"cart\"; axis = [1.0, 0.0]") +
                    element("revolute", "pin", "a = { body = \"rod\", at = [0.0, 0.0] }; b = \"cart\"") +
                    rope("line", "a = { body = \"rod\", at = [0.0, -2.0] }; b = { body = \"ground\", at = [-1.0, -2.0] }; length = 2.0");
  std::vector<double> rates;
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
    const Run r = run_in(text, coordinates, 1.0);
    REQUIRE(r.event_times("line", "closes its gap").size() >= 1);
    const double t = r.event_times("line", "closes its gap")[0];
    const Run before = run_in(text, coordinates, t - 1e-9), after = run_in(text, coordinates, t + 1e-9);
    const double jump_cart = after.last("cart.vx") - before.last("cart.vx"), jump_rod = after.last("rod.vx") - before.last("rod.vx");
    // The rope's direction is that from its anchor to the rod's end.
    const double theta = after.last("rod.theta"), ex = after.last("rod.x") + std::sin(theta) + 1.0,
                 ey = after.last("rod.y") - std::cos(theta) + 2.0, length = std::hypot(ex, ey);
    CHECK(std::abs(length - 2.0) < 1e-8);
    const double impulse = after.last("line.impulse");
    CHECK(impulse > 0.1);
    CHECK(std::abs(4.0 * jump_cart + jump_rod + impulse * ex / length) < 1e-7); // 1e-9 s of velocities that change by 10 m/s²
    CHECK(std::abs(after.last("line.rate")) < 1e-10);
    CHECK(r.result.statistics.energy_residual < 1e-9);
    rates.push_back(after.last("rod.omega"));
    rates.push_back(jump_cart);
  }
  CHECK(std::abs(rates[0] - rates[2]) < 1e-8);
  CHECK(std::abs(rates[1] - rates[3]) < 1e-8);
}

// What a stiff rope does tends to that as k grows, if its damper grows with it: of the velocity k m/c² comes back, and it is
// stretched by v m/c; both fall as c = 4 k^¾ (in SI) does.
TEST_CASE("a stiff rope tends to the inextensible one") {
  const auto text = [](const std::string& law) {
    return k_no_gravity + body("rod", "mass = 1; inertia = 0.1; position = [0.0, 0.0]; velocity = [1.0, 0.5]") +
           element("rope", "line",
                   "a = { body = \"rod\", at = [0.0, 0.4] }; b = { body = \"ground\", at = [-1.0, 0.0] }; slack = 0.1; " + law);
  };
  const Run exact = run_in(text("inextensible = true"), Coordinates::absolute, 0.5, "rodas5p");
  double last = 1.0;
  for (const double k : {1e5, 1e7, 1e9}) {
    const double c = 4.0 * std::pow(k, 0.75);
    const Run r =
        run_in(text("stiffness = " + std::to_string(k) + "; damping = " + std::to_string(c)), Coordinates::absolute, 0.5, "rodas5p");
    double off = 0.0;
    for (const char* name : {"rod.x", "rod.y", "rod.theta", "rod.vx", "rod.vy", "rod.omega"})
      off = std::max(off, std::abs(r.last(name) - exact.last(name)));
    CHECK(off < 0.5 * last);
    last = off;
  }
  CHECK(last < 1e-5); // v m/c = 4e-8 m, k m/c² = 2e-6 of 1 m/s
}

TEST_CASE("ropes side by side are caught together and share the load, and one more than needed is no harm") {
  const auto text = [](const std::string& more) {
    return body("beam", "mass = 6; inertia = 2; position = [0.0, -1.0]") +
           rope("left", "a = { body = \"beam\", at = [-1.0, -1.0] }; b = { body = \"ground\", at = [-1.0, 0.0] }; slack = 0.2") +
           rope("right", "a = { body = \"beam\", at = [1.0, -1.0] }; b = { body = \"ground\", at = [1.0, 0.0] }; slack = 0.2") + more;
  };
  const double v = std::sqrt(2.0 * k_g * 0.2);
  const Run two = run_in(text(""), Coordinates::absolute, 0.5);
  for (const char* name : {"left", "right"}) {
    CHECK(two.event_times(name).size() == 1);
    CHECK(std::abs(two.last(std::string(name) + ".impulse") - 3.0 * v) < 1e-8);
    CHECK(std::abs(two.last(std::string(name) + ".tension") - 3.0 * k_g) < 1e-9);
  }
  CHECK(std::abs(two.last("beam.vy")) < 1e-11);
  CHECK(std::abs(two.last("beam.omega")) < 1e-11);
  const Run three =
      run_in(text(rope("middle", "a = { body = \"beam\", at = [0.0, -1.0] }; b = { body = \"ground\", at = [0.0, 0.0] }; slack = 0.2")),
             Coordinates::absolute, 0.5);
  CHECK(std::abs(three.last("left.tension") + three.last("middle.tension") + three.last("right.tension") - 6.0 * k_g) < 1e-9);
  for (const char* name : {"left.tension", "middle.tension", "right.tension"}) CHECK(three.last(name) >= -1e-9);
  CHECK(std::abs(three.result.statistics.dissipated - 6.0 * k_g * 0.2) < 1e-8);
  CHECK(std::abs(three.last("beam.y") + 1.2) < 1e-10);
  // Two of one length between the same points.
  const Run same =
      run_in(point_mass("mass", 2.0, 0.0, -1.0, 0.0, 0.0) + rope("one", std::string("a = \"mass\"; slack = 0.5; ") + k_ceiling) +
                 rope("two", std::string("a = \"mass\"; slack = 0.5; ") + k_ceiling),
             Coordinates::absolute, 1.0);
  CHECK(std::abs(same.last("one.tension") + same.last("two.tension") - 2.0 * k_g) < 1e-9);
  CHECK(std::abs(same.result.statistics.dissipated - 2.0 * k_g * 0.5) < 1e-8);
}

TEST_CASE("a taut rope bears a blow that pulls at it, and lets go where the blow would have it push") {
  const std::string hanging = point_mass("upper", 3.0, 0.0, -1.0, 0.0, 0.0) + rope("hanger", std::string("a = \"upper\"; ") + k_ceiling);
  const double v = std::sqrt(2.0 * k_g * 0.3);
  const Run down =
      run_in(hanging + point_mass("lower", 2.0, 0.0, -1.5, 0.0, 0.0) + rope("line", "a = \"upper\"; b = \"lower\"; slack = 0.3"),
             Coordinates::absolute, 1.0);
  CHECK(std::abs(down.last("hanger.impulse") - 2.0 * v) < 1e-8);
  CHECK(std::abs(down.last("line.impulse") - 2.0 * v) < 1e-8);
  CHECK(std::abs(down.last("hanger.tension") - 5.0 * k_g) < 1e-9);
  CHECK(down.event_times("hanger").empty());
  // Thrown upward past the hanging mass, and caught by it.
  const std::string text =
      hanging + point_mass("thrown", 2.0, 0.5, -1.0, 0.0, 8.0) + rope("line", "a = \"upper\"; b = \"thrown\"; length = 1.0");
  const Run up = run_in(text, Coordinates::absolute, 1.0);
  const double t = up.event_times("line", "closes its gap").at(0);
  CHECK(up.event_times("hanger", "enters its gap").at(0) == t);
  const Run after = run_in(text, Coordinates::absolute, t + 1e-9);
  const double rise = std::sqrt(0.75), fast = std::sqrt(64.0 - 2.0 * k_g * rise); // the line is 1 m long at 0.5 m beside it
  // Along the line (½, √¾) 2 kg and 3 kg share the momentum.
  const double along = 0.4 * fast * rise;
  CHECK(std::abs(after.last("upper.vx") - 0.5 * along) < 1e-7);
  CHECK(std::abs(after.last("upper.vy") - rise * along) < 1e-7);
}

// The floor's friction has a bound, a blow has none: what sticks bears nothing of it and slides.
TEST_CASE("friction bears no blow") {
  const std::string text =
      body("block", "mass = 4; inertia = 1; position = [0.0, 0.0]") +
      element("unilateral_contact", "sole", "a = \"block\"; stiffness = 1e6; damping = 4000.0; preload = 39.24") +
      element("coulomb_stick", "friction", "contacts = [\"sole\"]; static_friction = 0.5") + point_mass("ball", 1.0, 0.5, 0.0, 3.0, 0.0) +
      element("point_on_line", "rail", "a = \"ball\"; axis = [1.0, 0.0]") + rope("line", "a = \"block\"; b = \"ball\"; length = 1.0");
  const Run r = run_in(text, Coordinates::absolute, 1.0);
  const double t = r.event_times("line", "closes its gap").at(0);
  CHECK(std::abs(t - 0.5 / 3.0) < 1e-9);
  CHECK(r.event_times("friction", "slips forward").at(0) == t);
  const Run after = run_in(text, Coordinates::absolute, t + 1e-9);
  CHECK(std::abs(after.last("block.vx") - 0.6) < 1e-7);
  CHECK(std::abs(after.last("ball.vx") - 0.6) < 1e-7);
  // Then the ball pulls the block on against its friction until both rest.
  CHECK(std::abs(r.last("block.x") - 0.36 / (2.0 * 0.5 * k_g * 4.0 / 5.0)) < 1e-8);
  CHECK(std::abs(r.result.statistics.dissipated - 4.5) < 1e-8);
  CHECK(r.result.statistics.energy_residual < 1e-8);
}

TEST_CASE("what a drive gives in a blow is its work") {
  const std::string text =
      k_no_gravity + body("tug", "mass = 5; inertia = 1; position = [0.0, 0.0]; velocity = [2.0, 0.0]") +
      point_mass("load", 3.0, -0.5, 0.0, 0.0, 0.0) + signal_entry("constant", "speed", "value = 2.0") +
      element("prescribed_motion", "engine", "a = \"tug\"; coordinate = \"x\"; signal = \"speed\"; as = \"velocity\"") +
      rope("line", "a = \"tug\"; b = \"load\"; length = 1.0");
  const Run r = run_in(text, Coordinates::absolute, 1.0);
  CHECK(std::abs(r.event_times("line", "closes its gap").at(0) - 0.25) < 1e-10);
  CHECK(std::abs(r.last("load.vx") - 2.0) < 1e-11);
  CHECK(std::abs(r.result.statistics.dissipated - 6.0) < 1e-10); // ½ m V²
  CHECK(std::abs(r.result.statistics.work - 12.0) < 1e-10);      // m V · V
  CHECK(r.result.statistics.energy_residual < 1e-10);
}

TEST_CASE("a rope that is straight without load stays as it is") {
  const std::string text = k_no_gravity + point_mass("one", 2.0, 0.0, 0.0, 0.3, 0.0) + point_mass("two", 1.0, 1.0, 0.0, 0.3, 0.0) +
                           rope("line", "a = \"one\"; b = \"two\"");
  const Run r = run_in(text, Coordinates::absolute, 5.0);
  CHECK(r.result.events.empty());
  CHECK(std::abs(r.last("line.tension")) < 1e-12);
  CHECK(std::abs(r.last("line.length") - 1.0) < 1e-12);
}

TEST_CASE("a start that stretches it is a blow at the start") {
  const std::string text = k_no_gravity + point_mass("one", 3.0, 0.0, 0.0, 0.0, 0.0) + point_mass("two", 1.0, 1.0, 0.0, 2.0, 0.0) +
                           rope("line", "a = \"one\"; b = \"two\"");
  const Run r = run_in(text, Coordinates::absolute, 1.0);
  REQUIRE(r.result.events.size() == 1);
  CHECK(r.result.events[0].t == 0.0);
  CHECK(r.result.events[0].kind == EventKind::closes_gap);
  CHECK(std::abs(r.last("two.vx") - 0.5) < 1e-12);
  CHECK(std::abs(r.result.statistics.dissipated - 1.5) < 1e-12);
}

// With sin φ = s where it goes slack the energy above the bottom is (1 + 3 s/2) m g L; it is caught with the radial velocity
// 8 (v cos φ)³/(g L), so that each blow takes 32 s³ (1 − s²)³ m g L, ever less: it goes on forever, on ever more of a circle.
TEST_CASE("a pendulum that is caught again and again loses what the closed form says each time") {
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
    Run r;
    const Model model = read_model(STEPLAP_MODELS "/machines/rope_pendulum.toml", transformer_catalog());
    r.system = compile(model);
    SimulationOptions o = options({"dop853", 1e-11, 8.0});
    o.coordinates = coordinates;
    r.result = simulate(*r.system, r.system->initial_state(), o);
    const std::size_t blows = r.event_times("rope", "closes its gap").size();
    REQUIRE(blows >= 3);
    CHECK(blows < 10);
    double s = 0.2 / 3.0, lost = 0.0;
    for (std::size_t i = 0; i < blows; ++i) {
      const double share = 32.0 * std::pow(s, 3) * std::pow(1.0 - s * s, 3);
      lost += share;
      s -= share / 1.5;
    }
    CHECK(std::abs(r.result.statistics.dissipated - lost * k_g) < 1e-7);
    CHECK(r.result.statistics.energy_residual < 1e-8);
  }
}

// A beam of much inertia (J > m l²) on two ropes is dropped askew: each blow lifts both of its ends, so that they are caught in turn, ever
// sooner. That ends with both taut, since a flight of a billionth of the length is none. What is left of the motion there does not
// hang on how exactly it was followed: at both tolerances the same blows within 1e-6 of the velocities.
TEST_CASE("ropes that are caught in turn come to rest") {
  const std::string text =
      body("beam", "mass = 6; inertia = 30; position = [0.0, -1.0]; angle = 0.05") +
      rope("left", "a = { body = \"beam\", at = [-1.0, -1.05] }; b = { body = \"ground\", at = [-1.2, 0.0] }; length = 1.3") +
      rope("right", "a = { body = \"beam\", at = [1.0, -0.95] }; b = { body = \"ground\", at = [1.2, 0.0] }; length = 1.3");
  std::vector<double> lost;
  for (const double tolerance : {1e-9, 1e-11}) {
    Run r;
    r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
    r.result = simulate(*r.system, r.system->initial_state(), options({"dop853", tolerance, 3.0}));
    CHECK(r.event_times("left").size() + r.event_times("right").size() >= 3);
    CHECK(r.event_times("left").size() + r.event_times("right").size() < 100);
    CHECK(std::abs(r.last("left.length") - 1.3) < 1e-9);
    CHECK(std::abs(r.last("right.length") - 1.3) < 1e-9);
    CHECK(r.last("left.tension") > 0.0);
    CHECK(r.last("right.tension") > 0.0);
    CHECK(r.result.statistics.energy_residual < 1e-6);
    lost.push_back(r.result.statistics.dissipated);
  }
  CHECK(std::abs(lost[0] - lost[1]) < 1e-6 * lost[0]);
}

TEST_CASE("the energy that blows take counts with the rope's own") {
  const std::string text = "[output]\nalso = [\"line.dissipated\"]\n" + point_mass("mass", 2.0, 0.0, -1.0, 0.0, 0.0) +
                           rope("line", std::string("a = \"mass\"; slack = 0.5; ") + k_ceiling);
  const Run r = run_in(text, Coordinates::absolute, 1.0);
  CHECK(std::abs(r.last("line.dissipated") - 2.0 * k_g * 0.5) < 1e-8);
}

// At rest: taut what pulls, slack what would push; a small swing of what hangs is that of a pendulum.
TEST_CASE("rest and vibrations know which ropes are taut") {
  const auto rest_of = [](const std::string& text) {
    Rest rest{compile(scene(text + "\n[simulation]\nstep = 1e-3\n")), {}};
    rest.found = find_equilibrium(*rest.system, rest.system->initial_state());
    return rest;
  };
  const std::string hook = "b = { body = \"ground\", at = [0.0, 0.0] }; inextensible = true";
  // From where it is slack: it hangs below, and swings with √(g/L).
  const Rest hangs = rest_of(body("bob", "mass = 2; inertia = 0.1; position = [0.3, -1.0]") +
                             element("rope", "line", "a = \"bob\"; length = 1.5; " + hook));
  CHECK(std::abs(hangs.found.state.q[3]) < 1e-9);
  CHECK(std::abs(hangs.found.state.q[4] + 1.5) < 1e-9);
  CHECK(hangs.found.state.friction[0].phase == FrictionPhase::stick);
  const VibrationModes swings = vibration_modes(*hangs.system, hangs.found.state);
  REQUIRE(swings.modes.size() >= 1);
  CHECK(std::abs(std::abs(swings.modes[0].eigenvalue.imag()) - std::sqrt(k_g / 1.5)) < 1e-8);
  // A spring alone holds it higher than the rope would, or lower.
  for (const double k : {100.0, 10.0}) {
    CAPTURE(k);
    const Rest rest = rest_of(
        body("bob", "mass = 2; inertia = 0.1; position = [0.0, -1.0]") +
        element("spring_damper", "spring",
                "a = \"bob\"; b = { body = \"ground\", at = [0.0, 0.0] }; stiffness = " + std::to_string(k) + "; free_length = 1.0") +
        element("point_on_line", "guide", "a = \"bob\"; axis = [0.0, 1.0]") + element("rope", "line", "a = \"bob\"; slack = 0.5; " + hook));
    const double alone = 2.0 * k_g / k; // 0.196 and 1.962 m
    CHECK(std::abs(rest.found.state.q[4] + 1.0 + std::min(alone, 0.5)) < 1e-9);
    CHECK((rest.found.state.friction[0].phase == FrictionPhase::stick) == (alone > 0.5));
  }
  // Taut as given, but it would have to push: the boom falls to the other side.
  const Rest boom = rest_of(body("boom", "mass = 10; inertia = 1; position = [-0.1, 1.0]") +
                            element("revolute", "foot", "a = { body = \"boom\", at = [0.0, 0.0] }") +
                            element("rope", "stay", "a = \"boom\"; b = { body = \"ground\", at = [0.0, -2.0] }; inextensible = true"));
  CHECK(std::abs(boom.found.state.q[3]) < 1e-9);
  CHECK(boom.found.state.q[4] < -1.0);
  CHECK(boom.found.state.friction[0].phase != FrictionPhase::stick);
  // A run begins there with nothing to do.
  SimulationOptions o = options({"dop853", 1e-10, 0.2});
  const RunResult run = simulate(*hangs.system, hangs.found.state, o);
  CHECK(run.events.empty());
}

TEST_CASE("what cannot be done with an inextensible rope is refused") {
  const std::string mass = point_mass("mass", 2.0, 0.0, -1.0, 0.0, 0.0) +
                           "[[marker]]\nname = \"sheave\"\nbody = \"ground\"\npoint = [1.0, 0.0]\n" +
                           body("other", "mass = 1; inertia = 1; position = [2.0, -1.0]");
  const auto fails = [&](const std::string& fields, const std::string& simulation = "step = 1e-3") {
    CHECK_THROWS_AS((void)compile(scene(mass + element("rope", "line", fields) + "[simulation]\n" + simulation + "\n")), ModelError);
  };
  fails("a = \"mass\"");
  fails("a = \"mass\"; stiffness = 1e5; inextensible = true");
  fails("a = \"mass\"; damping = 1e5; inextensible = true");
  fails("a = \"mass\"; pretension = 10.0; inextensible = true");
  fails("a = \"mass\"; length = 0.9; inextensible = true");
  fails("a = \"mass\"; inextensible = true", "step = 1e-3\nintegrator = \"moreau\"");
  const auto system = compile(scene(mass + rope("line", "a = \"mass\"") + "[simulation]\nstep = 1e-3\n"));
  SimulationOptions o = options({"dop853", 1e-9, 0.1});
  o.integrator = "moreau";
  o.settings.step = 1e-3;
  CHECK_THROWS_AS((void)simulate(*system, system->initial_state(), o), NumericalFailure);
  // Over points of the same two bodies it runs.
  const Run r = run_in(mass +
                           rope("line", std::string("a = \"mass\"; over = [\"peg\", \"sheave\"]; slack = 0.1; ") +
                                            "b = { body = \"ground\", at = [2.0, 0.0] }") +
                           "[[marker]]\nname = \"peg\"\nbody = \"ground\"\npoint = [0.0, 0.0]\n",
                       Coordinates::absolute, 1.0);
  CHECK(std::abs(r.last("mass.y") + 1.1) < 1e-10);
  CHECK(std::abs(r.last("line.length") - 3.1) < 1e-10);
}
