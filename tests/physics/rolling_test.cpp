// Circles on segments and on circles, gears and racks, motors, stops and bearing friction against closed forms.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81, k_pi = std::numbers::pi;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// A ball of 2 kg, radius 0.1 m, J = 2/5 m r², on a ramp that falls by `slope` along x, pressed in by its weight.
std::string ball_on_ramp(double slope, double mu) {
  const double k = 1e6, depth = 2.0 * k_g * std::cos(slope) / k, height = 0.1 + 0.005 - depth;
  return "[[body]]\nname = \"ball\"\nmass = 2.0\ninertia = 0.008\nposition = [" + number(height * std::sin(slope)) + ", " +
         number(height * std::cos(slope)) + "]\n" +
         "[[element]]\nkind = \"segment_contact\"\nname = \"ramp\"\na = \"ball\"\nradius = 0.1\nfrom = [" + number(-std::cos(slope)) +
         ", " + number(std::sin(slope)) + "]\nto = [" + number(4 * std::cos(slope)) + ", " + number(-4 * std::sin(slope)) +
         "]\nthickness = 0.01\nstiffness = 1e6\ndamping = 200.0\n" +
         "[[element]]\nkind = \"coulomb_stick\"\nname = \"grip\"\ncontacts = [\"ramp\"]\nstatic_friction = " + number(mu) + "\n";
}

} // namespace

// Rolling: a = g sin α/(1 + J/(m r²)) = 5/7 g sin α while tan α < 7/2 μ; beyond that it slides:
// a = g (sin α − μ cos α) and spins up with μ g cos α m r/J.
TEST_CASE("a ball on a ramp rolls as long as friction suffices, then slides") {
  for (const double slope : {0.1, 0.5, 0.8}) {
    CAPTURE(slope);
    const double mu = 0.2;
    const Run r = run(ball_on_ramp(slope, mu), {"dop853", 1e-11, 0.5, 0.0});
    const bool rolls = std::tan(slope) < 3.5 * mu;
    const double a = rolls ? 5.0 / 7.0 * k_g * std::sin(slope) : k_g * (std::sin(slope) - mu * std::cos(slope));
    const double spin = rolls ? a / 0.1 : mu * k_g * std::cos(slope) * 2.0 * 0.1 / 0.008;
    CHECK(std::hypot(r.last("ball.vx"), r.last("ball.vy")) == doctest::Approx(a * 0.5).epsilon(1e-9));
    CHECK(r.last("ball.omega") == doctest::Approx(-spin * 0.5).epsilon(1e-9));
    CHECK(r.last("grip.mode") == (rolls ? 1.0 : 2.0));
  }
}

// Inside a ring of radius R a ball that rolls swings as a pendulum of length (R − r)(1 + J/(m r²)): at the
// bottom φ'² = 2 g (1 − cos φ₀)/((R − r)(1 + 2/5)). The ring gives by m g/k = 2e-7 m, up to twice as much as it
// swings: relative errors of that over R.
TEST_CASE("a ball in a ring swings as the pendulum that it is, and keeps its energy") {
  const double start = 0.9, reach = 0.5;
  const Run r = run("[[body]]\nname = \"ball\"\nmass = 2.0\ninertia = 0.008\nposition = [" + number(reach * std::sin(start)) + ", " +
                        number(-reach * std::cos(start)) + "]\n" +
                        element("circle_contact", "ring",
                                "a = 'ball'; radius_a = 0.1; radius_b = 0.6; "
                                "inside = true; stiffness = 1e8") +
                        element("coulomb_stick", "grip", "contacts = ['ring']; static_friction = 2.0"),
                    {"dop853", 1e-10, 1.5, 1e-3});
  double fastest = 0.0;
  for (const double v : r.series("ball.vx")) fastest = std::max(fastest, std::abs(v));
  CHECK(fastest == doctest::Approx(std::sqrt(2.0 * k_g * reach * (1.0 - std::cos(start)) / 1.4)).epsilon(1e-5));
  // Touching the ring again and again costs nothing without damping; the drop onto it at the start is elastic.
  CHECK(r.result.statistics.energy_residual < 1e-7 * r.result.statistics.energy_exchanged);
}

// Over the end of a plate: the potential has a continuous gradient there, so nothing is lost or gained.
TEST_CASE("a smooth ball slides over the end of a plate without losing energy") {
  const Run r = run(body("ball", "mass = 1.0; inertia = 0.004; position = [-0.1, 0.109]; velocity = [0.4, 0.0]") +
                        element("segment_contact", "plate",
                                "a = 'ball'; radius = 0.1; from = [-1.0, 0.0]; to = [0.0, 0.0]; "
                                "thickness = 0.02; stiffness = 1e5"),
                    {"dop853", 1e-11, 0.8, 1e-2});
  CHECK(r.last("ball.y") < -0.1); // it fell past the end
  CHECK(r.last("plate.gap") > 0.0);
  CHECK(r.last("ball.omega") == 0.0); // the force passes through its centre
  CHECK(r.result.statistics.energy_residual < 1e-8 * r.result.statistics.energy_exchanged);
  const double energy = 0.5 * (std::pow(r.last("ball.vx"), 2) + std::pow(r.last("ball.vy"), 2)) + k_g * r.last("ball.y");
  const double pressed = 0.5 * 1e5 * std::pow(0.11 - 0.109, 2);
  CHECK(energy == doctest::Approx(0.5 * 0.16 + k_g * 0.109 + pressed).epsilon(1e-8));
}

// Off the round end with friction: it rolls on (sticks) round the corner, then slides and leaves.
TEST_CASE("a rolling ball goes round the end of a plate and falls off") {
  const Run r = run(body("ball", "mass = 1.0; inertia = 0.004; position = [-0.05, 0.10990190]; velocity = [0.1, 0.0]; "
                                 "angular_velocity = -1.0") +
                        element("segment_contact", "plate",
                                "a = 'ball'; radius = 0.1; from = [-1.0, 0.0]; to = [0.0, 0.0]; "
                                "thickness = 0.02; stiffness = 1e5; damping = 60.0") +
                        element("coulomb_stick", "grip", "contacts = ['plate']; static_friction = 0.5"),
                    {"dop853", 1e-10, 1.2, 1e-3});
  REQUIRE(r.event_times("grip", "changes foot").size() >= 1);
  // Rolling with v = 0.1 m/s it is at the end after 0.5 s.
  CHECK(r.event_times("grip", "changes foot").front() == doctest::Approx(0.5).epsilon(1e-6));
  CHECK(r.event_times("plate", "opens").size() == 1);
  CHECK(r.event_times("plate", "opens").front() > 0.6); // round the corner, not off it at once
  CHECK(r.last("ball.y") < -0.1);
  // The turn about the end begins with a gradient that differs by the depth over the reach, 1e-3, of a speed
  // of 0.1 m/s: that much squared of the kinetic energy may change.
  CHECK(r.result.statistics.energy_residual < 1e-4 * r.result.statistics.energy_exchanged);
}

// --- gears ------------------------------------------------------------------------------------------------

TEST_CASE("gears: a couple on one accelerates both, and the teeth bear what the other takes") {
  const Run r = run(k_no_gravity + body("small", "mass = 1.0; inertia = 0.02") +
                        body("large", "mass = 4.0; inertia = 0.3; position = [0.4, 0.0]") + element("revolute", "pin 1", "a = 'small'") +
                        element("revolute", "pin 2", "a = 'large'; b = { body = 'ground', at = [0.4, 0.0] }") +
                        element("gear", "mesh", "a = 'small'; b = 'large'; radius_a = 0.1; radius_b = 0.3") +
                        element("load", "drive", "at = 'small'; couple = 2.0"),
                    {"dop853", 1e-12, 2.0, 0.0});
  const double alpha = 2.0 / (0.02 + 0.3 / 9.0);
  CHECK(r.last("small.omega") == doctest::Approx(2.0 * alpha).epsilon(1e-11)); // linear in t: exact but for rounding
  CHECK(r.last("large.omega") == doctest::Approx(-2.0 * alpha / 3.0).epsilon(1e-11));
  CHECK(r.last("small.theta") == doctest::Approx(2.0 * alpha).epsilon(1e-11)); // more than one turn
  CHECK(std::abs(r.last("mesh.force")) == doctest::Approx(0.3 * alpha / 3.0 / 0.3).epsilon(1e-11));
}

// The teeth brake the gear that a couple drives, outside and inside alike: the force on its rim is against its motion.
TEST_CASE("gears: the force of the teeth has the sign of the rim's motion, in a ring, too") {
  for (const bool inside : {false, true}) {
    const std::string place = inside ? "[0.2, 0.0]" : "[0.4, 0.0]";
    const Run r =
        run(k_no_gravity + body("small", "mass = 1.0; inertia = 0.02") + body("large", "mass = 4.0; inertia = 0.3; position = " + place) +
                element("revolute", "pin 1", "a = 'small'") +
                element("revolute", "pin 2", "a = 'large'; b = { body = 'ground', at = " + place + " }") +
                element("gear", "mesh",
                        std::string("a = 'small'; b = 'large'; radius_a = 0.1; radius_b = 0.3; inside = ") + (inside ? "true" : "false")) +
                element("load", "drive", "at = 'small'; couple = 2.0"),
            {"dop853", 1e-12, 1.0, 0.0});
    const double alpha = 2.0 / (0.02 + 0.3 / 9.0);
    CHECK(r.last("mesh.force") == doctest::Approx(-(2.0 - 0.02 * alpha) / 0.1).epsilon(1e-11));
  }
}

// A planet between a ring that stands and a sun: Willis, ω_sun r_s + ... : with the carrier at Ω the sun turns
// at Ω (1 + R/r_s) and the planet at −Ω (R − r_p)/r_p.
TEST_CASE("gears: a planetary train obeys Willis' equation while its carrier goes round") {
  const Run r = run(k_no_gravity + body("sun", "mass = 1.0; inertia = 0.02") +
                        body("planet", "mass = 1.0; inertia = 0.01; position = [0.3, 0.0]") + body("carrier", "mass = 2.0; inertia = 0.1") +
                        element("revolute", "sun pin", "a = 'sun'") + element("revolute", "carrier pin", "a = 'carrier'") +
                        element("revolute", "planet pin", "a = 'planet'; b = { body = 'carrier', at = [0.3, 0.0] }") +
                        element("gear", "sun mesh", "a = 'planet'; b = 'sun'; radius_a = 0.1; radius_b = 0.2") +
                        element("gear", "ring mesh", "a = 'planet'; b = 'ground'; radius_a = 0.1; radius_b = 0.4; inside = true") +
                        element("load", "drive", "at = 'sun'; couple = 0.5"),
                    {"dop853", 1e-12, 4.0, 0.0});
  CHECK(std::abs(r.last("carrier.theta")) > 2.0 * k_pi); // more than once round
  const double carrier = r.last("carrier.omega");
  CHECK(carrier > 0.5);
  CHECK(r.last("sun.omega") == doctest::Approx(3.0 * carrier).epsilon(1e-10));
  CHECK(r.last("planet.omega") == doctest::Approx(-3.0 * carrier).epsilon(1e-10));
  // Reduced to the sun, J = J_s + J_p (ω_p/ω_s)² + (J_c + m_p 0.3²)/9: constant couple, constant acceleration.
  const double inertia = 0.02 + 0.01 + (0.1 + 0.09) / 9.0;
  CHECK(r.last("sun.omega") == doctest::Approx(0.5 / inertia * 4.0).epsilon(1e-10));
}

TEST_CASE("rack: a pinion's couple drives a mass along") {
  const Run r =
      run(k_no_gravity + body("pinion", "mass = 1.0; inertia = 0.02; position = [0.0, 0.1]") + body("table", "mass = 50.0; inertia = 5.0") +
              element("revolute", "pin", "a = 'pinion'; b = { body = 'ground', at = [0.0, 0.1] }") +
              element("prismatic", "guide", "a = 'table'") + element("rack", "rack", "a = 'pinion'; b = 'table'; radius = 0.1") +
              element("load", "drive", "at = 'pinion'; couple = 3.0"),
          {"dop853", 1e-12, 1.0, 0.0});
  const double alpha = 3.0 / (0.02 + 50.0 * 0.01);
  CHECK(r.last("pinion.omega") == doctest::Approx(alpha).epsilon(1e-11));
  CHECK(r.last("table.vx") == doctest::Approx(0.1 * alpha).epsilon(1e-11)); // the tooth above it moves with it
}

// --- motors, stops, bearings -----------------------------------------------------------------------------------

TEST_CASE("motor: a straight characteristic brings a rotor to its no-load speed exponentially") {
  const std::string rotor = k_no_gravity + body("rotor", "mass = 1.0; inertia = 0.5") + element("revolute", "pin", "a = 'rotor'");
  const Run r =
      run(rotor + element("motor", "motor", "a = 'rotor'; constant_effort = 4.0; no_load_speed = 20.0"), {"dop853", 1e-12, 2.0, 0.0});
  CHECK(r.last("rotor.omega") == doctest::Approx(20.0 * (1.0 - std::exp(-4.0 / (20.0 * 0.5) * 2.0))).epsilon(1e-11));
  CHECK(r.result.statistics.work == doctest::Approx(0.25 * std::pow(r.last("rotor.omega"), 2)).epsilon(1e-11));
  // A servo is a spring and damper whose rest moves: here with critical damping from −0.3 rad.
  const Run servo = run(rotor + signal_entry("constant", "wanted", "value = 0.3") +
                            element("motor", "servo", "a = 'rotor'; target = 'wanted'; proportional = 50.0; derivative = 10.0"),
                        {"dop853", 1e-12, 0.7, 0.0});
  const double omega = 10.0, t = 0.7; // √(50/0.5)
  CHECK(servo.last("rotor.theta") == doctest::Approx(0.3 * (1.0 - (1.0 + omega * t) * std::exp(-omega * t))).epsilon(1e-10));
}

// In contact a mass swings on the stop's spring for half a period, then flies back with its speed reversed.
TEST_CASE("limit: a mass bounces between its stops without loss") {
  const Run r =
      run(k_no_gravity + body("mass", "mass = 2.0; inertia = 1.0; velocity = [0.5, 0.0]") + element("prismatic", "guide", "a = 'mass'") +
              element("limit", "stops", "a = 'mass'; coordinate = 'x'; lower = -0.2; upper = 0.1; stiffness = 2e4"),
          {"dop853", 1e-12, 1.3, 0.0});
  const double half = k_pi / 100.0; // π √(m/k)
  const auto upper = r.event_times("stops", "reaches its upper stop"), lower = r.event_times("stops", "reaches its lower stop"),
             left = r.event_times("stops", "leaves its stop");
  REQUIRE(upper.size() == 1);
  REQUIRE(lower.size() == 1);
  REQUIRE(left.size() >= 2);
  CHECK(upper[0] == doctest::Approx(0.2).epsilon(1e-11));
  CHECK(left[0] == doctest::Approx(0.2 + half).epsilon(1e-11));
  CHECK(lower[0] == doctest::Approx(0.2 + half + 0.6).epsilon(1e-11));
  CHECK(r.last("mass.vx") == doctest::Approx(0.5).epsilon(1e-10));
}

TEST_CASE("joint friction: a wheel runs down in J w/T and stays; it starts where the couple exceeds what holds") {
  const std::string wheel = k_no_gravity + body("wheel", "mass = 1.0; inertia = 0.5; angular_velocity = @") +
                            element("revolute", "pin", "a = 'wheel'") +
                            element("joint_friction", "bearing", "a = 'wheel'; holds = 3.0; drags = 2.0");
  const auto with = [&](const std::string& omega) { return std::string(wheel).replace(wheel.find('@'), 1, omega); };
  const Run down = run(with("8.0"), {"dop853", 1e-12, 3.0, 0.0});
  REQUIRE(down.event_times("bearing", "sticks").size() == 1);
  CHECK(down.event_times("bearing", "sticks")[0] == doctest::Approx(0.5 * 8.0 / 2.0).epsilon(1e-12));
  CHECK(std::abs(down.last("wheel.omega")) < 1e-14);
  CHECK(down.last("wheel.theta") == doctest::Approx(8.0).epsilon(1e-11)); // ω²J/(2T)
  CHECK(down.result.statistics.dissipated == doctest::Approx(16.0).epsilon(1e-11));
  // A couple that rises by 2 N m/s: starts at 1.5 s, then J ω = ∫ (2 t − 2) dt.
  const Run up = run(with("0.0") + signal_entry("triangle", "ramp", "peak = 20.0; duration = 20.0") +
                         element("load", "couple", "at = 'wheel'; torque = 'ramp'"),
                     {"dop853", 1e-12, 2.5, 0.0});
  REQUIRE(up.event_times("bearing", "slips forward").size() == 1);
  CHECK(up.event_times("bearing", "slips forward")[0] == doctest::Approx(1.5).epsilon(1e-12));
  CHECK(up.last("wheel.omega") == doctest::Approx(2.0 * (2.5 * 2.5 - 2.0 * 2.5 - (1.5 * 1.5 - 2.0 * 1.5))).epsilon(1e-11));
}
