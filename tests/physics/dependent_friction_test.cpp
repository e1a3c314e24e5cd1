// Friction whose rows depend on a drive's, on each other's, or on gears: it holds together only where all of them can be
// at rest at once, and lets go or turns round together where they cannot.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

const std::vector<Settings> k_methods = {
    {"auto", 1e-10, 0.5}, {"tsit5", 1e-10, 0.5}, {"dop853", 1e-10, 0.5}, {"rodas5p", 1e-10, 0.5}, {"rk4", 1e-4, 0.5}};

// A wheel turned by a drive at cos(2π f t + phase) rad/s, with bearing friction of 1 N m.
std::string driven_wheel(double frequency, double phase) {
  return "[[signal]]\nname = \"turn\"\nkind = \"harmonics\"\namplitudes = [1.0]\nfrequencies = [" + number(frequency) + "]\nphases = [" +
         number(phase) + "]\n[[body]]\nname = \"wheel\"\nmass = 1.0\ninertia = 1.0\nangular_velocity = " + number(std::cos(phase)) + R"(
[[element]]
kind = "revolute"
name = "pin"
a = "wheel"
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "wheel"
coordinate = "angle"
signal = "turn"
as = "velocity"
[[element]]
kind = "joint_friction"
name = "bearing"
a = "wheel"
holds = 1.0
)";
}

} // namespace

TEST_CASE("dependent friction: on a driven coordinate it slides at the drive's rate, and turns round where the drive does") {
  for (const double phase : {-0.5 * k_pi, 0.0, 1.0})
    for (const Settings& s : k_methods) {
      CAPTURE(s.integrator);
      CAPTURE(phase);
      const double frequency = 2.0, w = 2.0 * k_pi * frequency, end = 0.6;
      Settings whole = s;
      whole.end = end;
      whole.output_step = 0.01;
      const Run r = run(driven_wheel(frequency, phase), whole);
      // |∫| piecewise: friction of 1 N m takes 1 J a radian.
      double path = 0.0;
      constexpr int n = 60000;
      for (int i = 0; i < n; ++i) path += std::abs(std::cos(w * (i + 0.5) * end / n + phase)) * end / n;
      CHECK(std::abs(r.result.statistics.dissipated - path) < (s.integrator == "rk4" ? 1e-6 : 1e-8));
      const std::vector<double> friction = r.series("bearing.friction"), rate = r.series("bearing.slip_rate");
      for (std::size_t i = 1; i < friction.size(); ++i) {
        if (std::abs(rate[i]) < 1e-9) continue; // turns round at a sample
        CHECK(std::abs(friction[i] + (rate[i] > 0.0 ? 1.0 : -1.0)) < 1e-12);
      }
      CHECK(r.result.statistics.energy_residual < 1e-7);
    }
}

TEST_CASE("dependent friction: a foot dragged by a drive that starts and stops takes what it takes, no more") {
  // Velocity −haversine of 0.4 s from 0.1 s on, 0.2 m in all, μN = 49.05 N: 9.81 J.
  const std::string text = R"(
[[signal]]
name = "v"
kind = "haversine"
peak = -1.0
start = 0.1
duration = 0.4
[[body]]
name = "box"
mass = 10.0
inertia = 1.0
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "box"
signal = "v"
as = "velocity"
[[element]]
kind = "rotational_spring_damper"
name = "rot"
a = "box"
stiffness = 1e4
[[element]]
kind = "unilateral_contact"
name = "foot"
a = "box"
stiffness = 1e5
damping = 100.0
preload = 98.1
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["foot"]
static_friction = 0.5
)";
  for (const Settings& s : k_methods) {
    CAPTURE(s.integrator);
    const Run r = run(text, {s.integrator, s.step_or_tolerance, 0.6});
    REQUIRE(r.event_times("friction", "slips backward").size() == 1);
    REQUIRE(r.event_times("friction", "sticks").size() == 1);
    CHECK(std::abs(r.event_times("friction", "slips backward")[0] - 0.1) < 1e-4); // once the drive outdoes the spring
    CHECK(std::abs(r.event_times("friction", "sticks")[0] - 0.5) < 1e-4);
    CHECK(std::abs(r.result.statistics.dissipated - 9.81) < 1e-3); // the lever of the sunk foot turns the box a little
  }
}

namespace {

// A box on feet, each with its own friction, that rocks: on the tilted box the feet are not equally high, and move
// against each other.
struct Foot {
  double x, preload, friction;
};

std::string rocking(const std::vector<Foot>& feet) {
  std::string text = "[[body]]\nname = \"box\"\nmass = 10.0\ninertia = 0.6\nposition = [0.0, 0.25]\nangular_velocity = 0.05\n";
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const std::string of = std::to_string(i), at = "[" + number(feet[i].x) + ", 0.0]";
    text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot " + of + "\"\na = { body = \"box\", at = " + at +
            " }\nb = { body = \"ground\", at = " + at + " }\nstiffness = 6e4\npreload = " + number(feet[i].preload) +
            "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"friction " + of + "\"\ncontacts = [\"foot " + of +
            "\"]\nstatic_friction = " + number(feet[i].friction) + "\n";
  }
  return text;
}

// The same with friction that is smooth over `eps` m/s, by the classical Runge–Kutta method: angular velocity at `end`.
double regularised(const std::vector<Foot>& feet, double end, double eps, double h) {
  using Vector = std::array<double, 6>;
  const auto rates = [eps, &feet](const Vector& s) {
    double fx = 0.0, fy = -98.1, m = 0.0;
    const double c = std::cos(s[2]), sine = std::sin(s[2]);
    for (const auto& [x, preload, mu] : feet) {
      const double rx = c * x + sine * 0.25, ry = sine * x - c * 0.25, gap = s[1] + ry;
      const double n = std::max(0.0, preload - 6e4 * gap);
      const double f = -mu * n * std::tanh((s[3] - s[5] * ry) / eps);
      fx += f;
      fy += n;
      m += rx * n - ry * f;
    }
    return Vector{s[3], s[4], s[5], fx / 10.0, fy / 10.0, m / 0.6};
  };
  const auto moved = [](const Vector& s, double by, const Vector& k) {
    Vector r = s;
    for (std::size_t i = 0; i < 6; ++i) r[i] += by * k[i];
    return r;
  };
  Vector s{0.0, 0.25, 0.0, 0.0, 0.0, 0.05};
  const int steps = static_cast<int>(std::lround(end / h));
  for (int i = 0; i < steps; ++i) {
    const Vector k1 = rates(s), k2 = rates(moved(s, 0.5 * h, k1)), k3 = rates(moved(s, 0.5 * h, k2)), k4 = rates(moved(s, h, k3));
    for (std::size_t j = 0; j < 6; ++j) s[j] += h / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
  }
  return s[5];
}

} // namespace

TEST_CASE("dependent friction: a box that rocks on two feet goes on rocking, as with smoothed friction in the limit") {
  // The feet move against each other by some 1e-5 m/s. Smoothing over eps well below that errs in proportion to eps: two
  // of them extrapolated; steps by the stability of the smoothed friction, μN/(m eps) up to 1e7/s.
  const std::vector<Foot> feet = {{-0.3, 49.05, 0.5}, {0.3, 49.05, 0.3}};
  const double coarse = regularised(feet, 0.3, 1e-6, 4e-7), fine = regularised(feet, 0.3, 5e-7, 2e-7), limit = 2.0 * fine - coarse;
  CHECK(std::abs(fine - coarse) < 5e-5);
  for (const Settings& s : k_methods) {
    CAPTURE(s.integrator);
    const Run r = run(rocking(feet), {s.integrator, s.step_or_tolerance, 0.3});
    CHECK(std::abs(r.last("box.omega") - limit) < std::abs(fine - coarse)); // what extrapolation corrects
    CHECK(r.result.statistics.energy_residual < 1e-6 * r.result.statistics.energy_scale);
  }
}

// Two of three rows hold while it is tilted, one where it passes the level: which of them depend on others changes from one time
// that all stick to the next.
TEST_CASE("dependent friction: a box that rocks on three feet goes on rocking, as with smoothed friction in the limit") {
  const std::vector<Foot> feet = {{-0.3, 32.7, 0.5}, {0.0, 32.7, 0.4}, {0.3, 32.7, 0.3}};
  const double end = 0.2, coarse = regularised(feet, end, 1e-6, 4e-7), fine = regularised(feet, end, 5e-7, 2e-7),
               limit = 2.0 * fine - coarse;
  CHECK(std::abs(fine - coarse) < 5e-5);
  for (const Settings& s : k_methods) {
    CAPTURE(s.integrator);
    const Run r = run(rocking(feet), {s.integrator, s.step_or_tolerance, end});
    CHECK(std::abs(r.last("box.omega") - limit) < std::abs(fine - coarse));
    CHECK(r.result.statistics.energy_residual < 1e-6 * r.result.statistics.energy_scale);
  }
}

// At a plate's end a soft contact's force moves from below the ball's centre towards the corner, to another point of the ball:
// one that moves where the old one was at rest. Friction slides there; a blow that stopped it would take energy at once.
TEST_CASE("a ball that rolls past the end of a plate slides at the corner") {
  const std::string text = R"(
[[body]]
name = "ball"
mass = 2.245178
inertia = 0.0005568131
position = [-0.03503582, 0.28856]
velocity = [0.02917125, -0.0193914]
[[element]]
kind = "segment_contact"
name = "plate"
a = "ball"
b = { body = "ground", at = [0.0, 0.0] }
radius = 0.0249
from = [-0.232, -0.01361925]
to = [0.232, 0.01361925]
thickness = 0.0116
stiffness = 10512.49
damping = 9.623893
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["plate"]
static_friction = 0.4785476
)";
  std::vector<double> x;
  for (const Settings& s : k_methods) {
    CAPTURE(s.integrator);
    const Run r = run(text, {s.integrator, s.step_or_tolerance, 0.4});
    CHECK(r.event_times("friction", "changes foot").size() + r.event_times("friction").size() > 1);
    // 1e-10 a step, some hundred steps. rk4 has 4e-4 J from the fall onto the plate, before the end is passed.
    if (s.integrator != "rk4") CHECK(r.result.statistics.energy_residual < 1e-7 * r.result.statistics.energy_scale);
    x.push_back(r.last("ball.omega"));
  }
  // rk4's contact is resolved by 150 steps of fourth order; the others to their tolerances.
  for (const double value : x) CHECK(std::abs(value - x[0]) < 1e-4 * std::abs(x[0]));
}

namespace {

// Two geared wheels in bearings with friction, brought to a stop and turned round by a torque: both bearings change
// their direction at the same instant.
std::string geared(double inertia_b) {
  return R"(
[[signal]]
name = "pull"
kind = "constant"
value = -30.0
[[body]]
name = "a"
mass = 1.0
inertia = 2.0
angular_velocity = 3.0
[[body]]
name = "b"
mass = 1.0
inertia = )" +
         number(inertia_b) + R"(
position = [0.5, 0.0]
angular_velocity = -4.5
[[element]]
kind = "revolute"
name = "pin a"
a = "a"
[[element]]
kind = "revolute"
name = "pin b"
a = "b"
b = { body = "ground", at = [0.5, 0.0] }
[[element]]
kind = "gear"
name = "gear"
a = "a"
b = "b"
radius_a = 0.3
radius_b = 0.2
[[element]]
kind = "joint_friction"
name = "bearing a"
a = "a"
holds = 2.0
[[element]]
kind = "joint_friction"
name = "bearing b"
a = "b"
b = { body = "ground", at = [0.5, 0.0] }
holds = 1.0
[[element]]
kind = "load"
name = "load"
at = "a"
torque = "pull"
)";
}

} // namespace

TEST_CASE("dependent friction: geared bearings turn round together, at the same instant") {
  for (const double inertia : {0.5, 0.7, 1.1})
    for (const Settings& s : k_methods)
      for (const double tolerance : {s.step_or_tolerance, s.integrator == "rk4" ? 1e-3 : 1e-4}) {
        CAPTURE(s.integrator);
        CAPTURE(tolerance);
        const Run r = run(geared(inertia), {s.integrator, tolerance, 0.6, 0.01});
        // Seen from a: J = 2 + 1.5² J_b, friction 2 + 1.5 · 1 N m.
        const double j = 2.0 + 2.25 * inertia, drag = 3.5, stop = 3.0 * j / (30.0 + drag), after = 0.6 - stop;
        CHECK(std::abs(r.last("a.omega") + (30.0 - drag) / j * after) < (tolerance < 1e-6 || s.integrator == "rk4" ? 1e-9 : 1e-4));
        for (const char* bearing : {"bearing a", "bearing b"}) {
          const std::vector<double> friction = r.series(std::string(bearing) + ".friction"),
                                    rate = r.series(std::string(bearing) + ".slip_rate");
          for (std::size_t i = 0; i < rate.size(); ++i) CHECK(friction[i] * rate[i] <= 0.0); // never drives
          REQUIRE(r.event_times(bearing).size() == 2);                                       // it slides from the start, and turns round
          CHECK(r.event_times(bearing)[0] == 0.0);
          CHECK(std::abs(r.event_times(bearing)[1] - stop) < (tolerance < 1e-6 || s.integrator == "rk4" ? 1e-9 : 1e-4));
        }
      }
}

TEST_CASE("dependent friction: work of a machine in which everything is driven is the closed form, with every method") {
  // 1000 kg at sin(2π 2.2 t): the drive's work is the kinetic energy.
  for (const double end : {1.0, 0.8, 0.31})
    for (const Settings& s :
         {Settings{"auto", 1e-9}, Settings{"tsit5", 1e-9}, Settings{"dop853", 1e-9}, Settings{"rodas5p", 1e-9}, Settings{"rk4", 1e-3}}) {
      CAPTURE(s.integrator);
      CAPTURE(end);
      const Run r = run(R"(
[[signal]]
name = "v"
kind = "harmonics"
amplitudes = [1.0]
frequencies = [2.2]
phases = [-1.5707963267948966]
[[body]]
name = "cart"
mass = 1000.0
inertia = 100.0
[[element]]
kind = "prismatic"
name = "rail"
a = "cart"
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "cart"
signal = "v"
as = "velocity"
)",
                        {s.integrator, s.step_or_tolerance, end});
      const double speed = std::sin(2.0 * k_pi * 2.2 * end);
      // Of 500 J to and fro; a hundred steps of an error of 1e-9 each; rk4: h⁴ (2ω)⁵/2880 · 500 J.
      CHECK(std::abs(r.result.statistics.work - 500.0 * speed * speed) < 1e-4);
    }
}

namespace {

// A box of 1.3 kg on two unlike feet, each with a friction of its own, on a deck that is accelerated by up to 0.04 m/s². It
// holds; but it rocks, and where it is tilted one of its feet slides, by nanometres, as the other one does not.
std::string on_shaken_deck() {
  std::string text = R"(
gravity = [0.0, -9.81]
[[signal]]
name = "shake"
kind = "harmonics"
offset = -0.02
amplitudes = [0.02]
frequencies = [2.0]
[[body]]
name = "deck"
mass = 1.0
inertia = 0.01
position = [0.0, -0.1]
[[element]]
kind = "prismatic"
name = "rail"
a = "deck"
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "deck"
signal = "shake"
as = "acceleration"
[[body]]
name = "box"
mass = 1.3
inertia = 0.02
position = [0.0, 0.065]
)";
  const auto foot = [&text](const std::string& name, const std::string& x, const std::string& law, const std::string& friction) {
    text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + name + "\"\na = { body = \"box\", at = [" + x +
            ", 0.0] }\nb = { body = \"deck\", at = [" + x + ", 0.0] }\npreload = 6.5\n" + law +
            "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"friction " + name + "\"\ncontacts = [\"" + name + "\"]\n" + friction + "\n";
  };
  foot("left", "-0.1", "stiffness = 4300.0\ndamping = 0.0", "static_friction = 0.3\nkinetic_friction = 0.15");
  foot("right", "0.1", "stiffness = 7400.0\ndamping = 30.0", "static_friction = 0.6\nkinetic_friction = 0.24");
  return text;
}

// The same for small angles, its feet held to the deck: y above the level of no gap and θ, by the classical Runge–Kutta method.
std::array<double, 4> rocks_on_shaken_deck(double end) {
  using Vector = std::array<double, 4>;
  constexpr double m = 1.3, inertia = 0.02, h = 0.065, l = 0.1, w = 2.0 * k_pi * 2.0, step = 1e-5;
  const auto rates = [](double t, const Vector& s) {
    const double left = 6.5 - 4300.0 * (s[0] - l * s[1]), right = 6.5 - 7400.0 * (s[0] + l * s[1]) - 30.0 * (s[2] + l * s[3]);
    const double pull = 0.02 * (std::cos(w * t) - 1.0); // the deck's acceleration
    return Vector{s[2], s[3], (left + right) / m - 9.81,
                  (l * (right - left) + h * s[1] * (left + right) + m * h * pull) / (inertia + m * h * h)};
  };
  const auto moved = [](const Vector& s, double by, const Vector& k) {
    return Vector{s[0] + by * k[0], s[1] + by * k[1], s[2] + by * k[2], s[3] + by * k[3]};
  };
  Vector s{};
  const int steps = static_cast<int>(std::lround(end / step));
  for (int i = 0; i < steps; ++i) {
    const double t = i * step;
    const Vector k1 = rates(t, s), k2 = rates(t + 0.5 * step, moved(s, 0.5 * step, k1)),
                 k3 = rates(t + 0.5 * step, moved(s, 0.5 * step, k2)), k4 = rates(t + step, moved(s, step, k3));
    for (std::size_t j = 0; j < 4; ++j) s[j] += step / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
  }
  return s;
}

} // namespace

// Where a foot's slide turns round velocities are known to no better than the tolerance, and the other foot's row is nearly
// the same: to set both to rest where it has turned a little before would stop the rocking at once.
TEST_CASE("dependent friction: a box on two feet on a shaken deck goes on rocking, at every tolerance") {
  const double end = 0.5;
  const std::array<double, 4> held = rocks_on_shaken_deck(end);
  for (const Settings& s : {Settings{"dop853", 1e-10}, Settings{"dop853", 1e-6}, Settings{"tsit5", 1e-8}, Settings{"rodas5p", 1e-8},
                            Settings{"rodas5p", 1e-6}}) {
    CAPTURE(s.integrator);
    CAPTURE(s.step_or_tolerance);
    const Run r = run(on_shaken_deck(), {s.integrator, s.step_or_tolerance, end, 0.01});
    double widest = 0.0, fastest = 0.0;
    for (const double theta : r.series("box.theta")) widest = std::max(widest, std::abs(theta));
    for (const double omega : r.series("box.omega")) fastest = std::max(fastest, std::abs(omega));
    // Angles of 0.17 mrad: the equations of small angles leave out θ l/h = 3e-4 of what turns it at 70 rad/s, 1e-2 of a radian.
    CHECK(std::abs(r.last("box.theta") - held[1]) < 2e-2 * widest);
    CHECK(std::abs(r.last("box.omega") - held[3]) < 2e-2 * fastest);
    // The feet stay where they stand but for l θ²/2: the centre goes by the height times the angle.
    CHECK(std::abs(r.last("box.x") - r.last("deck.x") + 0.065 * r.last("box.theta")) < 1e-2 * 0.065 * widest);
    CHECK(r.result.statistics.energy_residual < s.step_or_tolerance * r.result.statistics.energy_scale);
  }
}
