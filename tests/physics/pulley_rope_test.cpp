// Inextensible ropes over pulleys that move: rows over several bodies, against closed forms.
//
// Tolerances: runs at 1e-11 over some hundred steps leave 1e-9 of values near 1; accelerations and tensions of the first
// instant, and what a blow does to given velocities, are exact to rounding.
#include "mbd/base/diagnostics.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/rest/freedom.h"
#include "mbd/rest/modes.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string point_body(const std::string& name, double mass, double x, double y, double vx = 0.0, double vy = 0.0) {
  return body(name, "mass = " + exact(mass) + "; inertia = 0.1; position = [" + exact(x) + ", " + exact(y) + "]; velocity = [" + exact(vx) +
                        ", " + exact(vy) + "]");
}

std::string ground_marker(const std::string& name, double x, double y) {
  return table_text("marker", "name = \"" + name + "\"\n", "body = \"ground\"; point = [" + exact(x) + ", " + exact(y) + "]");
}

std::string body_marker(const std::string& name, const std::string& of, double x, double y) {
  return table_text("marker", "name = \"" + name + "\"\n", "body = \"" + of + "\"; point = [" + exact(x) + ", " + exact(y) + "]");
}

std::string rope(const std::string& fields) { return element("rope", "rope", fields + "; inextensible = true"); }

std::string guide(const std::string& of, const std::string& on, const char* axis, double x, double y) {
  return element("prismatic", of + " guide",
                 "a = \"" + of + "\"; b = { body = \"" + on + "\", at = [" + exact(x) + ", " + exact(y) + "] }; axis = " + axis);
}

Run run_in(const std::string& text, Coordinates coordinates, double end, const std::string& method = "dop853") {
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  SimulationOptions o = options({method, method == "rk4" ? 1e-3 : 1e-11, end});
  o.coordinates = coordinates;
  r.result = simulate(*r.system, r.system->initial_state(), o);
  return r;
}

constexpr std::array<Coordinates, 2> k_both = {Coordinates::absolute, Coordinates::joint};

const std::string k_sheaves = ground_marker("left", -0.5, 0.0) + ground_marker("right", 0.5, 0.0);

// Two weights below two sheaves of the ground.
std::string atwood(double m1, double m2, double y1, double y2, const std::string& law) {
  return k_sheaves + point_body("one", m1, -0.5, y1) + point_body("two", m2, 0.5, y2) +
         rope("a = \"one\"; b = \"two\"; over = [\"left\", \"right\"]; " + law);
}

} // namespace

TEST_CASE("Atwood's machine: both weights accelerate by (m1 - m2) g/(m1 + m2), all along the rope is 2 m1 m2 g/(m1 + m2)") {
  const double m1 = 3.0, m2 = 2.0, a = (m1 - m2) * k_g / (m1 + m2), t = 0.6;
  const std::string text = "[output]\nalso = [\"one.ay\", \"two.ay\"]\n" + atwood(m1, m2, -1.0, -2.0, "");
  for (const Coordinates coordinates : k_both)
    for (const char* method : {"dop853", "rodas5p", "tsit5", "rk4", "auto"}) {
      CAPTURE(std::string(method));
      const Run r = run_in(text, coordinates, t, method);
      CHECK(r.result.events.empty());
      CHECK(std::abs(r.last("one.y") + 1.0 + 0.5 * a * t * t) < 1e-10);
      CHECK(std::abs(r.last("two.y") + 2.0 - 0.5 * a * t * t) < 1e-10);
      CHECK(std::abs(r.last("one.ay") + a) < 1e-10);
      CHECK(std::abs(r.last("two.ay") - a) < 1e-10);
      CHECK(std::abs(r.last("rope.tension") - 2.0 * m1 * m2 * k_g / (m1 + m2)) < 1e-9);
      CHECK(std::abs(r.last("rope.length") - 4.0) < 1e-11); // 1 m of it between the sheaves
      CHECK(std::abs(r.last("rope.rate")) < 1e-11);
      CHECK(r.last("rope.impulse") == 0.0);
      CHECK(r.result.statistics.energy_residual < 1e-9);
    }
}

TEST_CASE("models/machines/atwood.toml is its closed form") {
  Run r;
  const Model model = read_model(STEPLAP_MODELS "/machines/atwood.toml", transformer_catalog());
  r.system = compile(model);
  const double t = model.simulation.end;
  r.result = simulate(*r.system, r.system->initial_state(), options({"dop853", 1e-11, t}));
  // The pulley's block hangs on a spring: a mass M = m + 4 m1 m2/(m1 + m2) on it, 7 kg and two weights of 3 and 2 kg.
  const double reduced = 3.0 * 2.0 / (3.0 + 2.0), whole = 7.0 + 4.0 * reduced, omega = std::sqrt(2000.0 / whole);
  const double sag = whole * k_g / 2000.0 - 0.03; // below where it begins
  CHECK(std::abs(r.last("block.y") + sag * (1.0 - std::cos(omega * t))) < 1e-9);
  const double lift = sag * omega * omega * std::cos(omega * t); // upward is negative
  CHECK(std::abs(r.last("rope.tension") - 2.0 * reduced * (k_g - lift)) < 1e-7);
  const auto below = [&](double mass) { // of a weight, by T/m − g twice integrated
    return (2.0 * reduced / mass - 1.0) * 0.5 * k_g * t * t + 2.0 * reduced / mass * sag * (std::cos(omega * t) - 1.0);
  };
  CHECK(std::abs(r.last("heavy.y") + 0.8 - below(3.0)) < 1e-9);
  CHECK(std::abs(r.last("light.y") + 1.4 - below(2.0)) < 1e-9);
  CHECK(r.result.statistics.energy_residual < 1e-9);
}

// A weight beside a free carriage pulls a block along on it: T (1/m1 + 1/m2 + 1/(M + m2)) = g.
TEST_CASE("over a pulley on a carriage that is free to move") {
  const double block = 2.0, weight = 1.5, carriage = 5.0, t = 0.4;
  const double tension = k_g / (1.0 / block + 1.0 / weight + 1.0 / (carriage + weight));
  const std::string text = point_body("carriage", carriage, 0.0, -0.5) + point_body("block", block, -1.0, 0.0) +
                           point_body("weight", weight, 0.5, -1.0) + body_marker("pulley", "carriage", 0.5, 0.5) +
                           guide("carriage", "ground", "[1.0, 0.0]", 0.0, 0.0) + guide("block", "carriage", "[1.0, 0.0]", 0.0, 0.0) +
                           guide("weight", "carriage", "[0.0, 1.0]", 0.5, 0.0) + rope("a = \"block\"; b = \"weight\"; over = [\"pulley\"]");
  for (const Coordinates coordinates : k_both)
    for (const char* method : {"dop853", "rodas5p"}) {
      const Run r = run_in(text, coordinates, t, method);
      CHECK(std::abs(r.last("rope.tension") - tension) < 1e-9);
      CHECK(std::abs(r.last("block.x") + 1.0 - 0.5 * tension / block * t * t) < 1e-10);
      CHECK(std::abs(r.last("carriage.x") + 0.5 * tension / (carriage + weight) * t * t) < 1e-10);
      CHECK(std::abs(r.last("weight.y") + 1.0 - 0.5 * (tension / weight - k_g) * t * t) < 1e-10);
      CHECK(r.result.statistics.energy_residual < 1e-9);
    }
}

// 2 T − M g = M a_B, T − m g = m a, a = −2 a_B.
TEST_CASE("gun tackle: half the load and twice the way") {
  const double load = 30.0, weight = 12.0, t = 0.3, a = (2.0 * weight - load) * k_g / (load + 4.0 * weight);
  const std::string text =
      point_body("load", load, 0.0, -1.0) + point_body("weight", weight, 1.0, -1.0) + body_marker("near", "load", -0.2, 0.1) +
      body_marker("far", "load", 0.2, 0.1) + ground_marker("beam", 0.2, 0.0) + ground_marker("end", 1.0, 0.0) +
      rope("a = { body = \"ground\", at = [-0.2, 0.0] }; over = [\"near\", \"far\", \"beam\", \"end\"]; b = \"weight\"");
  for (const char* method : {"dop853", "rodas5p"}) {
    const Run r = run_in(text, Coordinates::absolute, t, method);
    CHECK(std::abs(r.last("load.y") + 1.0 - 0.5 * a * t * t) < 1e-10);
    CHECK(std::abs(r.last("weight.y") + 1.0 + a * t * t) < 1e-10);
    CHECK(std::abs(r.last("load.theta")) < 1e-12);
    CHECK(std::abs(r.last("rope.tension") - weight * (k_g - 2.0 * a)) < 1e-9);
    CHECK(std::abs(r.last("rope.length") - (0.9 + 0.4 + 0.9 + 0.8 + 1.0)) < 1e-11);
  }
}

// Two blocks on a rail with a weight in a shaft of each: 2 g = T (1/m1 + 1/m2 + 1/(M1 + m1) + 1/(M2 + m2)).
TEST_CASE("over two pulleys on different bodies") {
  const double m1 = 1.0, m2 = 1.4, b1 = 3.0, b2 = 4.0, t = 0.3;
  const double tension = 2.0 * k_g / (1.0 / m1 + 1.0 / m2 + 1.0 / (b1 + m1) + 1.0 / (b2 + m2));
  const std::string text = point_body("left block", b1, -1.0, 0.0) + point_body("right block", b2, 1.0, 0.0) +
                           point_body("one", m1, -1.0, -1.0) + point_body("two", m2, 1.0, -1.2) +
                           guide("left block", "ground", "[1.0, 0.0]", -1.0, 0.0) + guide("right block", "ground", "[1.0, 0.0]", 1.0, 0.0) +
                           guide("one", "left block", "[0.0, 1.0]", -1.0, 0.0) + guide("two", "right block", "[0.0, 1.0]", 1.0, 0.0) +
                           rope("a = \"one\"; over = [\"left block\", \"right block\"]; b = \"two\"");
  for (const Coordinates coordinates : k_both) {
    const Run r = run_in(text, coordinates, t); // eight rows of guides and the rope's: the sparse way
    CHECK(std::abs(r.last("rope.tension") - tension) < 1e-9);
    CHECK(std::abs(r.last("left block.x") + 1.0 - 0.5 * tension / (b1 + m1) * t * t) < 1e-10);
    CHECK(std::abs(r.last("right block.x") - 1.0 + 0.5 * tension / (b2 + m2) * t * t) < 1e-10);
    CHECK(std::abs(r.last("one.y") + 1.0 - 0.5 * (tension / m1 - k_g) * t * t) < 1e-10);
    CHECK(std::abs(r.last("two.y") + 1.2 - 0.5 * (tension / m2 - k_g) * t * t) < 1e-10);
    CHECK(r.result.statistics.energy_residual < 1e-9);
  }
}

// The sheave's body is driven upward with A, or welded to what is: weights as heavy as g + A would make them, and what drives
// and joins bears 2 T.
TEST_CASE("what holds the pulley bears twice the tension") {
  const double m1 = 3.0, m2 = 2.0, up = 2.0, t = 0.4, tension = 2.0 * m1 * m2 * (k_g + up) / (m1 + m2), frame = 4.0, sheave = 1.0;
  const std::string lift =
      signal_entry("constant", "up", "value = 2.0") + point_body("frame", frame, 0.0, 0.0) +
      element("prescribed_motion", "x", "a = \"frame\"; coordinate = \"x\"; signal = \"still\"") +
      signal_entry("constant", "still", "value = 0.0") +
      element("prescribed_motion", "turn", "a = \"frame\"; coordinate = \"angle\"; signal = \"still\"") +
      element("prescribed_motion", "motor", "a = \"frame\"; coordinate = \"y\"; signal = \"up\"; as = \"acceleration\"");
  const std::string weights = point_body("one", m1, -0.5, -1.0) + point_body("two", m2, 0.5, -1.5);
  for (const bool is_welded : {false, true}) {
    CAPTURE(is_welded);
    const std::string on = is_welded ? "sheave" : "frame";
    const std::string text =
        lift + weights +
        (is_welded ? point_body("sheave", sheave, 0.3, 0.2) + element("weld", "bolt", "a = \"sheave\"; b = \"frame\"") : "") +
        table_text("marker", "name = \"left\"\n", "body = \"" + on + "\"; at = [-0.5, 0.0]") +
        table_text("marker", "name = \"right\"\n", "body = \"" + on + "\"; at = [0.5, 0.0]") +
        rope("a = \"one\"; b = \"two\"; over = [\"left\", \"right\"]");
    const Run r = run_in(text, Coordinates::automatic, t);
    CHECK(std::abs(r.last("rope.tension") - tension) < 1e-9);
    CHECK(std::abs(r.last("motor.reaction") - ((frame + (is_welded ? sheave : 0.0)) * (k_g + up) + 2.0 * tension)) < 1e-8);
    CHECK(std::abs(r.last("one.y") + 1.0 - 0.5 * (tension / m1 - k_g) * t * t) < 1e-10);
    CHECK(r.result.statistics.energy_residual < 1e-9);
    if (is_welded) CHECK(std::abs(std::abs(r.last("bolt.force_y")) - (sheave * (k_g + up) + 2.0 * tension)) < 1e-8);
    if (is_welded) CHECK(std::abs(r.last("bolt.force_x")) < 1e-9);
  }
}

// u = v1 + v2 along the rope, A = 1/m1 + 1/m2 + 2/M: the pulley between two legs at right angles is pulled along both.
TEST_CASE("a blow moves all bodies of the rope, and keeps their momentum") {
  const double m1 = 2.0, m2 = 1.0, pulley = 4.0, v1 = 1.5, v2 = 0.5, slack = 0.2, u = v1 + v2;
  const double impulse = u / (1.0 / m1 + 1.0 / m2 + 2.0 / pulley);
  const std::string text = k_no_gravity + point_body("one", m1, -1.0, 0.0, -v1, 0.0) + point_body("pulley", pulley, 0.0, 0.0) +
                           point_body("two", m2, 0.0, -1.0, 0.0, -v2) + rope("a = \"one\"; b = \"two\"; over = [\"pulley\"]; slack = 0.2");
  for (const Coordinates coordinates : k_both) {
    const Run r = run_in(text, coordinates, slack / u + 1e-9); // velocities change by some 10 m/s² behind it
    REQUIRE(r.event_times("rope", "closes its gap").size() == 1);
    CHECK(std::abs(r.event_times("rope")[0] - slack / u) < 1e-10);
    CHECK(std::abs(r.last("rope.impulse") - impulse) < 1e-10);
    CHECK(std::abs(r.last("one.vx") - (-v1 + impulse / m1)) < 1e-7);
    CHECK(std::abs(r.last("two.vy") - (-v2 + impulse / m2)) < 1e-7);
    CHECK(std::abs(r.last("pulley.vx") + impulse / pulley) < 1e-7);
    CHECK(std::abs(r.last("pulley.vy") + impulse / pulley) < 1e-7);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * impulse * u) < 1e-10);
    CHECK(r.result.statistics.energy_residual < 1e-10);
    const Run later = run_in(text, coordinates, 2.0);
    CHECK(std::abs(m1 * later.last("one.vx") + m2 * later.last("two.vx") + pulley * later.last("pulley.vx") + m1 * v1) < 1e-9);
    CHECK(std::abs(m1 * later.last("one.vy") + m2 * later.last("two.vy") + pulley * later.last("pulley.vy") + m2 * v2) < 1e-9);
    CHECK(later.result.statistics.energy_residual < 1e-9);
  }
}

// Of the rope over a pulley that cannot give way: u over 1/m1 + 1/m2; what holds the pulley takes twice that.
TEST_CASE("a blow is shared with the rope that holds the pulley, and with a joint that does") {
  const double m1 = 3.0, m2 = 1.0, u = 1.0, impulse = u / (1.0 / m1 + 1.0 / m2);
  for (const bool is_hung : {true, false}) {
    CAPTURE(is_hung);
    const std::string holder =
        is_hung ? element("rope", "hanger", "a = \"pulley\"; b = { body = \"ground\", at = [0.0, 1.0] }; inextensible = true")
                : element("revolute", "hanger", "a = \"pulley\"");
    const Run r = run_in(k_no_gravity + point_body("pulley", 2.0, 0.0, 0.0) + point_body("one", m1, 0.0, -1.0, 0.0, -u) +
                             point_body("two", m2, 0.0, -1.2) + holder + rope("a = \"one\"; b = \"two\"; over = [\"pulley\"]; slack = 0.1"),
                         Coordinates::automatic, 0.2);
    REQUIRE(r.event_times("rope", "closes its gap").size() == 1);
    CHECK(std::abs(r.event_times("rope")[0] - 0.1) < 1e-10);
    CHECK(std::abs(r.last("rope.impulse") - impulse) < 1e-10);
    if (is_hung) CHECK(std::abs(r.last("hanger.impulse") - 2.0 * impulse) < 1e-10);
    CHECK(std::abs(r.last("one.vy") + u - impulse / m1) < 1e-10);
    CHECK(std::abs(r.last("two.vy") - impulse / m2) < 1e-10);
    CHECK(std::abs(r.last("pulley.vy")) < 1e-11);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * impulse * u) < 1e-10);
    CHECK(r.result.statistics.energy_residual < 1e-10);
  }
}

// A winch lets its end go for 0.2 s with 15 m/s², more than the load falls with, then on at 3 m/s: the load, which began at
// rest, has caught up where ½ g t² = 0.3 + 3 (t − 0.2), and is brought back from g t to 3 m/s.
TEST_CASE("a rope goes slack when it is let out faster than the load falls, and catches it again") {
  const double m = 2.0, t = (3.0 + std::sqrt(9.0 - 0.6 * k_g)) / k_g;
  const std::string text = k_sheaves + point_body("load", m, -0.5, -1.0) + point_body("end", 1.0, 0.5, -9.0) +
                           signal_entry("rectangle", "pull", "peak = 15.0; duration = 0.2") +
                           element("prescribed_motion", "winch", "a = \"end\"; coordinate = \"y\"; signal = \"pull\"") +
                           rope("a = \"load\"; b = \"end\"; over = [\"left\", \"right\"]");
  const Run r = run_in(text, Coordinates::absolute, 1.0);
  const std::vector<double> taut = r.event_times("rope", "closes its gap");
  REQUIRE(taut.size() == 1);
  CHECK(std::abs(taut[0] - t) < 1e-9);
  CHECK(std::abs(r.last("rope.impulse") - m * (k_g * t - 3.0)) < 1e-8);
  CHECK(std::abs(r.last("load.vy") + 3.0) < 1e-10);
  CHECK(std::abs(r.last("rope.tension") - m * k_g) < 1e-9);
  CHECK(r.result.statistics.energy_residual < 1e-8);
}

// N. B. Tufillaro, T. A. Abbott, D. J. Griffiths, Am. J. Phys. 52 (1984) 895: (m + M) r'' = m r θ'² − M g + m g cos θ,
// r θ'' + 2 r' θ' + g sin θ = 0, θ from the vertical, integrated here by itself.
TEST_CASE("a swinging Atwood machine follows its two equations") {
  const double m = 1.0, heavy = 1.6, end = 2.0;
  std::array<double, 4> y = {1.0, 1.2, 0.0, 0.0}; // r, θ, r', θ'
  const double r0 = y[0], theta0 = y[1];
  const auto rates = [&](const std::array<double, 4>& s) {
    return std::array<double, 4>{s[2], s[3], (m * s[0] * s[3] * s[3] - heavy * k_g + m * k_g * std::cos(s[1])) / (m + heavy),
                                 -(2.0 * s[2] * s[3] + k_g * std::sin(s[1])) / s[0]};
  };
  const auto along = [](std::array<double, 4> s, const std::array<double, 4>& d, double h) {
    for (int i = 0; i < 4; ++i) s[i] += h * d[i];
    return s;
  };
  constexpr int k_steps = 8000; // of 0.25 ms: h⁴ leaves 1e-13
  const double h = end / k_steps;
  for (int i = 0; i < k_steps; ++i) {
    const auto k1 = rates(y), k2 = rates(along(y, k1, 0.5 * h)), k3 = rates(along(y, k2, 0.5 * h)), k4 = rates(along(y, k3, h));
    for (int c = 0; c < 4; ++c) y[c] += h / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]);
  }
  REQUIRE(y[0] > 0.1); // it does not run onto the pulley
  const std::string text = ground_marker("left", 0.0, 0.0) + ground_marker("right", -1.0, 0.0) +
                           point_body("ball", m, r0 * std::sin(theta0), -r0 * std::cos(theta0)) + point_body("heavy", heavy, -1.0, -3.0) +
                           rope("a = \"ball\"; b = \"heavy\"; over = [\"left\", \"right\"]");
  for (const char* method : {"dop853", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run_in(text, Coordinates::automatic, end, method);
    CHECK(r.result.events.empty());
    CHECK(std::abs(r.last("ball.x") - y[0] * std::sin(y[1])) < 1e-8); // a swing multiplies errors by some ten
    CHECK(std::abs(r.last("ball.y") + y[0] * std::cos(y[1])) < 1e-8);
    CHECK(std::abs(r.last("heavy.y") + 3.0 - (y[0] - r0)) < 1e-8);
    CHECK(std::abs(r.last("heavy.x") + 1.0) < 1e-12);
    CHECK(r.result.statistics.energy_residual < 1e-9);
  }
}

// With a damper a stiff rope settles to the stretch T/k. Momentum tells by how much that moves each weight: its own share of it,
// T μ/(m k), μ = m1 m2/(m1 + m2): exact, and it falls as 1/k.
TEST_CASE("a stiff rope over pulleys tends to the inextensible one as 1/k") {
  const double m1 = 3.0, m2 = 2.0, mu = m1 * m2 / (m1 + m2), tension = 2.0 * mu * k_g;
  const Run limit = run_in(atwood(m1, m2, -1.0, -2.0, ""), Coordinates::absolute, 0.5, "rodas5p");
  for (const double k : {1e4, 1e5, 1e6}) {
    CAPTURE(k);
    const std::string law = "stiffness = " + exact(k) + "; damping = " + exact(2.0 * std::sqrt(k * mu));
    const std::string text = k_sheaves + point_body("one", m1, -0.5, -1.0) + point_body("two", m2, 0.5, -2.0) +
                             element("rope", "rope", "a = \"one\"; b = \"two\"; over = [\"left\", \"right\"]; " + law);
    const Run r = run_in(text, Coordinates::absolute, 0.5, "rodas5p"); // critically damped: exp(−0.5 √(k/μ)) < 1e-20 is left
    CHECK(std::abs((limit.last("one.y") - r.last("one.y")) * k - tension * mu / m1) < 1e-3 * tension * mu / m1 + 1e-9 * k);
    CHECK(std::abs((limit.last("two.y") - r.last("two.y")) * k - tension * mu / m2) < 1e-3 * tension * mu / m2 + 1e-9 * k);
  }
}

// 2 T = M g; the weight sinks until the peg's spring has what it is too heavy by, the load rises half of that. About there
// M (ẏ/2)² and m ẏ² move on the peg's spring.
TEST_CASE("a hoist at rest, and its slow vibration") {
  const double weight = 21.0, load = 40.0, k = 100.0, down = (weight - 0.5 * load) * k_g / k;
  const auto hoist = [&](const char* law) {
    return ground_marker("block", 0.0, 0.0) + ground_marker("turn", 1.0, 0.0) + point_body("load", load, 0.0, -2.0) +
           point_body("weight", weight, 1.0, -1.0) + guide("load", "ground", "[0.0, 1.0]", 0.0, 0.0) +
           guide("weight", "ground", "[0.0, 1.0]", 1.0, 0.0) +
           element("spring_damper", "peg",
                   "a = \"weight\"; b = { body = \"ground\", at = [1.0, -1.0] }; axis = [0.0, 1.0]; stiffness = 100.0; free_length = 0.0") +
           rope("a = { body = \"ground\", at = [0.0, 0.0] }; b = \"weight\"; over = [\"load\", \"block\", \"turn\"]" + std::string(law)) +
           "[simulation]\nstep = 1e-3\n";
  };
  // From where it is slack, too; by either algebra.
  for (const RestAlgebra algebra : {RestAlgebra::dense, RestAlgebra::sparse})
    for (const double slack : {0.0, 0.1}) {
      CAPTURE(slack);
      const auto loose = compile(scene(hoist(slack > 0.0 ? "; slack = 0.1" : "")));
      const Equilibrium rest = find_equilibrium(*loose, loose->initial_state(), algebra);
      CHECK(std::abs(rest.state.q[4] + 2.0 + 0.5 * slack - 0.5 * down) < 1e-10);
      CHECK(std::abs(rest.state.q[7] + 1.0 + down) < 1e-10);
      CHECK(rest.state.friction[0].phase == FrictionPhase::stick);
    }
  const auto system = compile(scene(hoist("")));
  const Equilibrium rest = find_equilibrium(*system, system->initial_state());
  const VibrationModes found = vibration_modes(*system, rest.state);
  REQUIRE(found.modes.size() == 1);
  CHECK(std::abs(std::abs(found.modes[0].eigenvalue.imag()) - std::sqrt(k / (weight + 0.25 * load))) < 1e-8);
  CHECK(count_freedom(*system).degrees_sticking() == 1);
  // A run begins there with nothing to do.
  SimulationOptions o = options({"dop853", 1e-10, 0.5});
  const RunResult run = simulate(*system, rest.state, o);
  CHECK(run.events.empty());
  CHECK(std::abs(run.trajectory->value(run.trajectory->size() - 1, run.trajectory->column("rope.tension")) - 0.5 * load * k_g) < 1e-7);
  CHECK(std::abs(run.trajectory->value(run.trajectory->size() - 1, run.trajectory->column("weight.vy"))) < 1e-8);
}

// A chain of rods hangs at one end of the rope: as long as it hangs straight it is one weight, each pin bears what is below it.
TEST_CASE("with a chain at its end: as many rows as the sparse equations begin with") {
  constexpr int k_rods = 6;
  const double rod = 0.5, m1 = k_rods * rod, m2 = 2.0, a = (m1 - m2) * k_g / (m1 + m2), t = 0.5;
  std::string text = k_sheaves + point_body("two", m2, 0.5, -1.5);
  for (int i = 0; i < k_rods; ++i) {
    const std::string name = "rod" + std::to_string(i);
    text += body(name, "mass = 0.5; inertia = 0.002; position = [-0.5, " + exact(-1.1 - 0.2 * i) + "]");
    if (i > 0)
      text += element("revolute", "pin" + std::to_string(i),
                      "a = { body = \"" + name + "\", at = [-0.5, " + exact(-1.0 - 0.2 * i) + "] }; b = { body = \"rod" +
                          std::to_string(i - 1) + "\", at = [-0.5, " + exact(-1.0 - 0.2 * i) + "] }");
  }
  text += rope("a = { body = \"rod0\", at = [-0.5, -1.0] }; b = \"two\"; over = [\"left\", \"right\"]");
  for (const char* method : {"dop853", "rodas5p"}) {
    const Run r = run_in(text, Coordinates::automatic, t, method);
    CHECK(std::abs(r.last("rod0.y") + 1.1 + 0.5 * a * t * t) < 1e-10);
    CHECK(std::abs(r.last("two.y") + 1.5 - 0.5 * a * t * t) < 1e-10);
    CHECK(std::abs(r.last("rope.tension") - m1 * (k_g - a)) < 1e-9);
    for (int i = 1; i < k_rods; ++i)
      CHECK(std::abs(std::abs(r.last("pin" + std::to_string(i) + ".force_y")) - (k_rods - i) * rod * (k_g - a)) < 1e-9);
    CHECK(r.result.statistics.energy_residual < 1e-9);
  }
  // Swinging it keeps its energy and its length.
  const std::string swung = text + "[simulation]\nstep = 1e-3\n";
  const auto system = compile(scene(swung));
  State state = system->initial_state();
  for (int i = 1; i <= k_rods + 1; ++i) state.v[3 * i + 2] = 0.3 * i;
  SimulationOptions o = options({"dop853", 1e-11, 0.6});
  const RunResult run = simulate(*system, state, o);
  CHECK(run.statistics.energy_residual < 1e-8);
  CHECK(run.trajectory->value(run.trajectory->size() - 1, run.trajectory->column("rope.tension")) > 1.0);
  CHECK(std::abs(run.trajectory->value(run.trajectory->size() - 1, run.trajectory->column("rope.length")) - 3.5) < 1e-11);
}

// A block on a rough table, pulled by a weight over a pulley: it holds while m g < μ M g, else both go with (m − μ M) g/(M + m).
TEST_CASE("friction holds against a rope, or gives way") {
  for (const double weight : {1.9, 2.6}) {
    CAPTURE(weight);
    const std::string text = point_body("block", 4.0, 0.0, 0.0) + point_body("weight", weight, 1.0, -1.0) +
                             ground_marker("edge", 1.0, 0.0) +
                             element("unilateral_contact", "sole", "a = \"block\"; stiffness = 1e6; damping = 4000.0; preload = 39.24") +
                             element("coulomb_stick", "friction", "contacts = [\"sole\"]; static_friction = 0.5") +
                             rope("a = \"block\"; b = \"weight\"; over = [\"edge\"]");
    const Run r = run_in(text, Coordinates::absolute, 0.3);
    const double a = std::max(0.0, (weight - 2.0) * k_g / (weight + 4.0));
    CHECK(r.event_times("friction").size() == (a > 0.0 ? 1 : 0));
    CHECK(std::abs(r.last("block.x") - 0.5 * a * 0.09) < 1e-9);
    CHECK(std::abs(r.last("weight.y") + 1.0 + 0.5 * a * 0.09) < 1e-9);
    CHECK(std::abs(r.last("rope.tension") - weight * (k_g - a)) < 1e-8);
  }
}

TEST_CASE("two ropes side by side share the load") {
  const double m1 = 3.0, m2 = 2.0, a = (m1 - m2) * k_g / (m1 + m2), t = 0.4;
  const std::string second = element("rope", "second", "a = \"one\"; b = \"two\"; over = [\"left\", \"right\"]; inextensible = true");
  const Run r = run_in(atwood(m1, m2, -1.0, -2.0, "") + second, Coordinates::absolute, t);
  CHECK(std::abs(r.last("one.y") + 1.0 + 0.5 * a * t * t) < 1e-10);
  CHECK(std::abs(r.last("rope.tension") - m1 * m2 * k_g / (m1 + m2)) < 1e-9);
  CHECK(std::abs(r.last("second.tension") - m1 * m2 * k_g / (m1 + m2)) < 1e-9);
}

TEST_CASE("what cannot be done with a rope over pulleys is told, and where") {
  const std::string bodies = k_sheaves + point_body("one", 3.0, -0.5, -1.0) + point_body("two", 2.0, 0.5, -2.0) +
                             body_marker("hook", "one", 0.2, 0.0) + body_marker("eye", "one", -0.2, 0.0) +
                             ground_marker("same", -0.5, -1.0);
  const auto message = [&](const std::string& fields, const std::string& simulation = "step = 1e-3") {
    try {
      (void)compile(scene(bodies + rope(fields) + "[simulation]\n" + simulation + "\n"));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto says = [&](const std::string& text, const char* part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  says(message("a = \"one\"; b = \"two\"; over = [\"same\", \"right\"]"), "'one' and 'same' coincide");
  says(message("a = \"hook\"; b = \"one\"; over = [\"eye\"]"), "two different bodies");
  says(message("a = \"one\"; b = \"two\"; over = [\"left\", \"right\"]; length = 3.9"), "less than the way over its points, 4 m");
  says(message("a = \"one\"; b = \"two\"; over = [\"left\", \"right\"]", "step = 1e-3\nintegrator = \"moreau\""), "does not locate where");
  // The lighter one runs up to its sheave: nothing is left of that part then, √(2 s/a) from the start.
  const double a = k_g / 5.0;
  for (const char* method : {"dop853", "rodas5p"}) try {
      (void)run_in(atwood(3.0, 2.0, -1.0, -0.5, ""), Coordinates::absolute, 2.0, method);
      CHECK(false);
    } catch (const NumericalFailure& failure) {
      const std::string text = failure.what();
      CAPTURE(text);
      CHECK(text.find("'right' and 'two' have met: nothing is left of rope 'rope' between them") != std::string::npos);
      const std::size_t at = text.find("t = ");
      REQUIRE(at != std::string::npos);
      CHECK(std::abs(std::stod(text.substr(at + 4)) - std::sqrt(2.0 * 0.5 / a)) < 1e-5); // a millionth of the rope before it is there
    }
  // A fixed step may go past it, where the direction of the pull is turned round: the energy guard does not let that pass.
  CHECK_THROWS_AS((void)run_in(atwood(3.0, 2.0, -1.0, -0.5, ""), Coordinates::absolute, 2.0, "rk4"), NumericalFailure);
}

namespace {

// What a run says as it breaks off, and when.
struct ReportedEvent {
  std::string text = "nothing";
  double t = -1.0;
};

ReportedEvent told_of(const std::string& text, double end, const std::string& method, double step = 1e-3) {
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  try {
    SimulationOptions o = options({method, method == "rk4" ? step : 1e-9, end});
    o.settings.step = step;
    (void)simulate(*r.system, r.system->initial_state(), o);
  } catch (const NumericalFailure& failure) {
    ReportedEvent told{failure.what()};
    if (const std::size_t at = told.text.find("t = "); at != std::string::npos) told.t = std::stod(told.text.substr(at + 4));
    return told;
  }
  return {};
}

constexpr const char* k_met = "have met: nothing is left of rope 'rope' between them, what it pulled has run onto its pulley";

} // namespace

// A rope that stretches is at its end where no more is left of its last part than it is stretched by. Weights that
// begin at rest reach that at √(2 s/a) less what T/k is passed in, the swinging of the spring beside it: 24 µm at 1.4
// m/s.
TEST_CASE("an elastic rope: a load that is pulled up to its pulley ends the run, with every method") {
  const double arrives = std::sqrt(2.0 * 0.5 / (k_g / 5.0));
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4", "moreau"}) {
    CAPTURE(std::string(method));
    const double step = 1e-4;
    const ReportedEvent told =
        told_of(atwood(3.0, 2.0, -1.0, -0.5, "")
                    .replace(atwood(3.0, 2.0, -1.0, -0.5, "").find("inextensible = true"), 19, "stiffness = 1e6\ndamping = 1e3"),
                2.0, method, step);
    CAPTURE(told.text);
    CHECK(told.text.find("'right' and 'two' ") != std::string::npos);
    CHECK(told.text.find(k_met) != std::string::npos);
    CHECK(std::abs(told.t - arrives) < (std::string(method) == "moreau" ? 2.0 * step : 5e-5)); // it looks at ends of steps only
  }
}

// A winch pulls a load of 200 kg up with 0.5 m/s, straight or swinging by 5 mrad: from 2 m below it is there after 4 s,
// less or more what its stretch and the longer way take (2 mm, 25 µm at 0.5 m/s).
TEST_CASE("a winch that pulls its load up to the pulley, on a rope that stretches or not") {
  for (const char* law : {"inextensible = true", "stiffness = 1e6\ndamping = 1e3"})
    for (const double aside : {0.0, 0.01})
      for (const char* method : {"auto", "dop853", "rodas5p"}) {
        CAPTURE(std::string(law));
        CAPTURE(aside);
        CAPTURE(std::string(method));
        const ReportedEvent told =
            told_of(point_body("winch", 10.0, -2.0, 0.0) + point_body("load", 200.0, aside, -2.0) + ground_marker("pulley", 0.0, 0.0) +
                        guide("winch", "ground", "[1.0, 0.0]", -2.0, 0.0) + signal_entry("constant", "speed", "value = -0.5") +
                        element("prescribed_motion", "hoist", "a = \"winch\"; coordinate = \"x\"; signal = \"speed\"; as = \"velocity\"") +
                        element("rope", "rope", "a = \"winch\"; b = \"load\"; over = [\"pulley\"]; " + std::string(law)),
                    5.0, method);
        CAPTURE(told.text);
        CHECK(told.text.find("'pulley' and 'load' ") != std::string::npos);
        CHECK(told.text.find(k_met) != std::string::npos);
        CHECK(std::abs(told.t - 4.0) < 5e-3);
      }
}

// Two bodies whose edges stand 10 mm apart, lashed down by one rope that is stretched by 20 mm: a part that is short
// because it was given so is no load that has met its pulley. The lower one bears T on its far side and on its edge.
TEST_CASE("a lashing over two edges that are near each other goes on") {
  const std::string text = k_no_gravity + point_body("one", 5.0, -0.305, 0.0) + point_body("two", 5.0, 0.305, 0.0) +
                           body_marker("left edge", "one", 0.3, 0.5) + body_marker("right edge", "two", -0.3, 0.5) +
                           ground_marker("left eye", -1.0, -1.0) + element("weld", "held one", "a = \"one\"") +
                           element("weld", "held two", "a = \"two\"") +
                           element("rope", "rope",
                                   "a = \"left eye\"; over = [\"left edge\", \"right edge\"]; b = { body = \"ground\", "
                                   "at = [1.0, -1.0] }; stiffness = 1e5; "
                                   "pretension = 2000.0");
  for (const char* method : {"dop853", "rodas5p", "moreau"}) CHECK(told_of(text, 0.1, method).text == "nothing");
}
