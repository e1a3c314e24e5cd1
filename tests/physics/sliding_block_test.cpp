// Blocks on planes: inclines at, below and above the friction angle, Newmark's sliding block under
// pulses, a block held for an hour.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <functional>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = 3.14159265358979323846;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// A block of 1 kg on a plane that falls towards +x at `angle`, on one contact under its centre of
// gravity, not turning; the contact carries the settled weight.
std::string incline(double angle, double mu, double speed) {
  const double s = std::sin(angle), c = std::cos(angle);
  return "[[body]]\nname = \"block\"\nmass = 1.0\ninertia = 1.0\nangle = " + number(-angle) + "\nvelocity = [" + number(speed * c) + ", " +
         number(-speed * s) + "]\n" + R"(
[[marker]]
name = "plane"
body = "ground"
at = [0.0, 0.0]
angle = )" +
         number(-angle) + R"(
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "block"
b = "plane"
stiffness = 1e4
damping = 20.0
preload = )" +
         number(9.81 * c) + R"(
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = )" +
         number(mu) + R"(
[[signal]]
name = "still"
kind = "constant"
value = 0.0
[[element]]
kind = "prescribed_motion"
name = "upright"
a = "block"
coordinate = "angle"
signal = "still"
)";
}

constexpr double k_slope = 20.0 * k_pi / 180.0;

double travelled(const Run& r) { return std::hypot(r.last("block.x"), r.last("block.y")); }

} // namespace

TEST_CASE("a block slides down an incline, slows and stops where the closed form says") {
  // B4c: 20°, μ = 0.5, 2 m/s. Constant deceleration is exact for every method.
  for (const Settings& settings : {Settings{"rk4", 1e-3, 3.0}, Settings{"tsit5", 1e-12, 3.0}, Settings{"dop853", 1e-12, 3.0}}) {
    CAPTURE(settings.integrator);
    const Run r = run(incline(k_slope, 0.5, 2.0), settings);
    const std::vector<double> sticks = r.event_times("friction", "sticks");
    REQUIRE(sticks.size() == 1);
    CHECK(std::abs(sticks[0] - 1.59492851148150) < 1e-12);
    CHECK(std::abs(travelled(r) - 1.59492851148150) < 1e-12);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * 9.81 * std::cos(k_slope) * 1.59492851148150) < 1e-11);
    CHECK(r.result.events.size() == 2); // it slips from the start
  }
}

TEST_CASE("a block on an incline below, at and above its friction angle") {
  const double limit = std::tan(k_slope);
  for (const double factor : {1.5, 1.0 + 1e-9, 1.0}) { // at the angle itself rounding must not move it
    CAPTURE(factor);
    const Run r = run(incline(k_slope, factor * limit, 0.0), {"rk4", 1e-2, 20.0, 1.0});
    CHECK(r.event_times("friction").empty());
    CHECK(travelled(r) < 1e-12); // what sticks is held to the projection's tolerance
    CHECK(r.last("friction.mode") == 1.0);
  }
  for (const double factor : {1.0 - 1e-9, 0.9, 0.0}) {
    CAPTURE(factor);
    const Run r = run(incline(k_slope, factor * limit, 0.0), {"dop853", 1e-10, 2.0});
    const double a = 9.81 * std::sin(k_slope) * (1.0 - factor);
    // 1e-13 m: the contact's own rounding; relative 1e-7: 1 − factor itself has eight digits
    CHECK(std::abs(travelled(r) - 0.5 * a * 4.0) < 1e-13 + 1e-7 * a);
    CHECK(r.last("friction.mode") == 2.0);
    CHECK(r.last("friction.slip_rate") > 0.0);
  }
}

namespace {

// A pulse of height A from 0 to T and its two integrals.
struct Pulse {
  const char* kind;
  std::function<double(double)> a, v, x; ///< for 0 ≤ t ≤ T
  double onset(double level) const {     // a rising front, by bisection
    double low = 0.0, high = 0.05;
    if (a(0.0) >= level) return 0.0;
    for (int i = 0; i < 200; ++i) (a(0.5 * (low + high)) < level ? low : high) = 0.5 * (low + high);
    return high;
  }
};

constexpr double k_peak = 5.886, k_duration = 0.1;

const std::vector<Pulse>& pulses() {
  static const double A = k_peak, T = k_duration, w = k_pi / T;
  static const std::vector<Pulse> list = {
      {"rectangle", [](double) { return A; }, [](double t) { return A * t; }, [](double t) { return 0.5 * A * t * t; }},
      {"triangle", [](double t) { return t < 0.5 * T ? 2.0 * A * t / T : 2.0 * A * (T - t) / T; },
       [](double t) { return t < 0.5 * T ? A * t * t / T : 0.5 * A * T - A * (T - t) * (T - t) / T; },
       [](double t) {
         const double u = T - t;
         return t < 0.5 * T ? A * t * t * t / (3.0 * T)
                            : A * T * T / 24.0 + 0.5 * A * T * (t - 0.5 * T) - A / (3.0 * T) * (T * T * T / 8.0 - u * u * u);
       }},
      {"haversine", [](double t) { return 0.5 * A * (1.0 - std::cos(2.0 * w * t)); },
       [](double t) { return 0.5 * A * (t - std::sin(2.0 * w * t) / (2.0 * w)); },
       [](double t) { return 0.5 * A * (0.5 * t * t - (1.0 - std::cos(2.0 * w * t)) / (4.0 * w * w)); }},
      {"half_sine", [](double t) { return A * std::sin(w * t); }, [](double t) { return A / w * (1.0 - std::cos(w * t)); },
       [](double t) { return A / w * (t - std::sin(w * t) / w); }}};
  return list;
}

// Slip of a rigid block on a base with this acceleration and friction μ g = level: it starts at the onset
// and ends where the relative velocity has returned to zero.
double newmark_slip(const Pulse& p, double level) {
  const double t1 = p.onset(level);
  const auto velocity = [&](double t) {
    const double u = std::min(t, k_duration);
    return p.v(u) - p.v(t1) - level * (t - t1);
  };
  double low = t1 + 0.2 * (k_duration - t1), high = 2.0;
  for (int i = 0; i < 200; ++i) (velocity(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const double t2 = high, u = std::min(t2, k_duration);
  const double base = p.x(u) + p.v(u) * (t2 - u) - p.x(t1) - p.v(t1) * (t2 - t1);
  return base - 0.5 * level * (t2 - t1) * (t2 - t1);
}

std::string on_a_base(const std::string& kind, double mu) {
  return R"(
[[signal]]
name = "pulse"
kind = ")" +
         kind + "\"\npeak = " + number(-k_peak) + "\nduration = " + number(k_duration) + R"(
[[signal]]
name = "still"
kind = "constant"
value = 0.0
[[body]]
name = "base"
mass = 10.0
inertia = 1.0
velocity = [0.6, 0.0]
[[body]]
name = "block"
mass = 1.0
inertia = 1.0
position = [0.0, 0.5]
velocity = [0.6, 0.0]
[[element]]
kind = "prismatic"
name = "rail"
a = "base"
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "base"
signal = "pulse"
[[element]]
kind = "prescribed_motion"
name = "upright"
a = "block"
coordinate = "angle"
signal = "still"
[[element]]
kind = "unilateral_contact"
name = "sole"
a = { body = "block", point = [0.0, -0.5] }
b = "base"
stiffness = 1e5
damping = 200.0
preload = 9.81
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = )" +
         number(mu) + "\n";
}

} // namespace

TEST_CASE("Newmark's sliding block under four pulses") {
  // Published slips, mm, for μ = 0.1 … 0.5 (peak 0.6 g, 0.1 s), and the closed forms behind them.
  const std::vector<std::vector<double>> published = {{147.15, 58.86, 29.43, 14.715, 5.886},
                                                      {30.653, 9.787, 3.602, 1.059, 0.132},
                                                      {32.02, 11.077, 4.631, 1.766, 0.401},
                                                      {53.825, 19.044, 8.135, 3.217, 0.772}};
  for (std::size_t p = 0; p < pulses().size(); ++p)
    for (int i = 0; i < 5; ++i) {
      const double mu = 0.1 * (i + 1);
      CAPTURE(std::string(pulses()[p].kind));
      CAPTURE(mu);
      const double exact = newmark_slip(pulses()[p], mu * 9.81);
      CHECK(std::abs(1e3 * exact - published[p][i]) < 0.51e-3 * (p == 2 && i == 0 ? 10.0 : 1.0));
      for (const Settings& settings : {Settings{"rk4", 1e-3, 1.0}, Settings{"dop853", 1e-11, 1.0}}) {
        const Run r = run(on_a_base(pulses()[p].kind, mu), settings);
        // The load is smooth between its breakpoints: rk4 makes (ωh)⁴ ~ 1e-7 of it, and the slip depends
        // on where it starts only to second order. dop853: ten times its tolerance. The block rests on its sole, and where
        // the pulse is over nothing but rounding limits a step: dense output of one of 20 periods' radians makes up to
        // 2e-9 m/s of that at tolerance 1e-10, which the friction hands on to the slip.
        CHECK(std::abs(r.last("friction.slide") - exact) < (settings.integrator == "rk4" ? 1e-7 : 1e-10) * exact + 1e-13);
        CHECK(r.last("friction.mode") == 1.0);
        CHECK(std::abs(r.last("block.vx") - r.last("base.vx")) < 1e-12); // the projection's tolerance
        CHECK(r.event_times("friction").size() == 2);                    // slips and sticks; under the rectangle it slips from the start
      }
    }
  // Rectangular: D = (A T)²/(2 μ g) (1 − μ g/A).
  const double level = 0.3 * 9.81, at = k_peak * k_duration;
  CHECK(newmark_slip(pulses()[0], level) == doctest::Approx(at * at / (2.0 * level) * (1.0 - level / k_peak)).epsilon(1e-13));
}

TEST_CASE("a block pushed with 0.99 μN for an hour does not move") {
  const auto pushed = [](double share) {
    return R"(
[[body]]
name = "block"
mass = 1000.0
inertia = 400.0
position = [0.0, 0.5]
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "block", point = [-1.0, -0.5] }
stiffness = 1e6
damping = 2e4
preload = 4905.0
[[element]]
kind = "unilateral_contact"
name = "front"
a = { body = "block", point = [1.0, -0.5] }
stiffness = 1e6
damping = 2e4
preload = 4905.0
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["rear", "front"]
static_friction = 0.4
[[element]]
kind = "load"
name = "push"
at = { body = "block", point = [0.0, -0.5] }
force = [)" +
           number(share * 0.4 * 9810.0) + ", 0.0]\n";
  };
  // Pushed at floor level: the friction acts 5 mm below (the tip of the compressed contact), which tilts
  // the block by microns in the first second; after that nothing may creep.
  for (const Settings& settings : {Settings{"rk4", 1e-2, 3600.0, 100.0}, Settings{"dop853", 1e-11, 3600.0, 100.0}}) {
    CAPTURE(settings.integrator);
    const Run r = run(pushed(0.99), settings);
    CHECK(r.event_times("friction", "slips forward").empty());
    const std::vector<double> slide = r.series("friction.slide"), x = r.series("block.x");
    for (std::size_t i = 1; i < x.size(); ++i) {
      // Projection holds the row to 1e-12 m; the adaptive method leaves some of its tolerance in the tilt.
      CHECK(std::abs(slide[i] - slide[1]) < (settings.integrator == "rk4" ? 2e-12 : 1e-11));
      CHECK(std::abs(x[i] - x[1]) < (settings.integrator == "rk4" ? 2e-12 : 1e-11));
    }
  }
  const Run moving = run(pushed(1.01), {"dop853", 1e-8, 1.0});
  CHECK(moving.last("friction.mode") == 2.0);
  CHECK(moving.last("block.x") > 0.0);
}

TEST_CASE("a block at rest is seen to slip under a load that passes its bound within one long step") {
  // Nothing moves before, so that no error limits the steps. Half a sine of 1 s, or the third crest of a sum of two
  // harmonics: from the bound up by a thousandth.
  const std::string block = R"(
[simulation]
step = 1e-3
[[body]]
name = "block"
mass = 1.0
inertia = 1.0
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "block"
stiffness = 1e5
damping = 400.0
preload = 9.81
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = 0.5
[[element]]
kind = "load"
name = "push"
at = "block"
force_x = "load"
)";
  const double bound = 0.5 * 9.81, pi = 3.14159265358979323846;
  for (const double overload : {1.06, 1.001, 1.00001}) {
    char signal[200];
    std::snprintf(signal, sizeof signal, "[[signal]]\nname = \"load\"\nkind = \"half_sine\"\npeak = %.17g\nduration = 1.0\n",
                  overload * bound);
    const double onset = std::asin(1.0 / overload) / pi;
    for (const char* method : {"tsit5", "dop853", "rodas5p", "auto"}) {
      CAPTURE(std::string(method));
      CAPTURE(overload);
      const Run r = run(scene(block + signal), {method, 1e-8, 2.0});
      const std::vector<double> slips = r.event_times("friction", "slips forward");
      REQUIRE(slips.size() == 1);
      // The bound may be passed by 1e-13 of itself; the load's slope there is π bound √(overload² − 1).
      CHECK(std::abs(slips[0] - onset) < 1e-12 / std::sqrt(overload * overload - 1.0));
      CHECK(r.event_times("friction", "sticks").size() == 1);
    }
  }
  // 9 and 11 periods a second beat: 2 sin 20πt cos 2πt, highest near t = 0 and 0.5 s.
  const std::string beat = "[[signal]]\nname = \"load\"\nkind = \"harmonics\"\namplitudes = [2.5, 2.5]\nfrequencies = [9.0, 11.0]\n"
                           "phases = [\"-90 deg\", \"-90 deg\"]\nstart = 0.2\n";
  for (const char* method : {"tsit5", "dop853", "rodas5p", "auto"}) {
    CAPTURE(std::string(method));
    const Run r = run(scene(block + beat), {method, 1e-8, 1.0});
    const std::vector<double> slips = r.event_times("friction");
    REQUIRE(slips.size() >= 1);
    // 5 |sin 20πτ cos 2πτ| = bound, τ = t − 0.2 s, for the first time: by steps of 1e-6 s and the last by bisection.
    const auto load = [&](double t) { return 5.0 * std::abs(std::sin(20.0 * pi * t) * std::cos(2.0 * pi * t)) - bound; };
    double low = 0.0;
    while (load(low + 1e-6) < 0.0) low += 1e-6;
    double high = low + 1e-6;
    for (int i = 0; i < 60; ++i) (load(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
    CHECK(std::abs(slips[0] - 0.2 - high) < 1e-11);
  }
}
