// Driven coordinates follow their signal exactly, and the multiplier is the inverse dynamics.
#include "elements/prescribed_motion.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_w = 2.0 * 3.14159265358979323846 * 1.5; // rad/s

// A body on a spring, driven by 0.2 cos(k_w t) as `level`; at = marker that is driven.
std::string driven(const std::string& coordinate, const std::string& level, const std::string& at, double speed) {
  return R"(
[[signal]]
name = "motion"
kind = "harmonics"
amplitudes = [0.2]
frequencies = [1.5]
[[body]]
name = "body"
mass = 3.0
inertia = 0.6
position = [)" +
         std::string(level == "position" ? "0.2" : "0.0") + R"(, 0.0]
velocity = [)" +
         std::to_string(speed) + R"(, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "body"
axis = [1.0, 0.0]
stiffness = 40.0
damping = 2.0
free_length = 0.0
[[element]]
kind = "bushing"
name = "seat"
a = { body = "body", point = [0.0, 0.0] }
stiffness = [0.0, 500.0]
damping = [0.0, 10.0]
rotational_stiffness = 30.0
rotational_damping = 0.5
[[element]]
kind = "prescribed_motion"
name = "drive"
a = )" + at +
         "\ncoordinate = \"" + coordinate + "\"\nsignal = \"motion\"\nas = \"" + level + "\"\n";
}

struct Jet {
  double x, v, a;
};

Jet expected(const std::string& level, double t, double v0) {
  const double c = 0.2 * std::cos(k_w * t), s = 0.2 * std::sin(k_w * t);
  if (level == "position") return {c, -k_w * s, -k_w * k_w * c};
  if (level == "velocity") return {s / k_w, c, -k_w * s};
  return {v0 * t + (0.2 - c) / (k_w * k_w), v0 + s / k_w, c};
}

} // namespace

TEST_CASE("x of a body follows its signal as position, velocity and acceleration; the reaction is what it takes") {
  for (const std::string level : {"position", "velocity", "acceleration"})
    // A body's own x is locked; the marker off its centre of gravity makes it a constraint row.
    for (const std::string at : {"\"body\"", "{ body = \"body\", point = [0.0, 0.1] }"})
      for (const Settings& settings : {Settings{"rk4", 1e-2, 2.0, 0.07}, Settings{"dop853", 1e-6, 2.0, 0.07}}) {
        CAPTURE(level);
        CAPTURE(at);
        CAPTURE(settings.integrator);
        const bool is_locked = at == "\"body\"";
        const Run r = run(driven("x", level, at, 0.5), settings);
        const std::vector<double> x = r.series("body.x"), v = r.series("body.vx"), a = r.series("body.ax"), theta = r.series("body.theta"),
                                  w = r.series("body.omega"), reaction = r.series("drive.reaction"), spring = r.series("spring.force");
        for (std::size_t i = 0; i < x.size(); ++i) {
          const Jet e = expected(level, r.times()[i], 0.5);
          // The marker's place: x − 0.1 sin θ. At a step's end the row holds to 1e-12, between them the
          // dense output does to its own order: a few times 1e-8 at these steps.
          const double tolerance = is_locked ? 1e-13 : 1e-6;
          const double arm = is_locked ? 0.0 : 0.1;
          CHECK(std::abs(x[i] - arm * std::sin(theta[i]) - e.x) < tolerance);
          CHECK(std::abs(v[i] - arm * std::cos(theta[i]) * w[i] - e.v) < 100.0 * tolerance);
          if (is_locked) CHECK(std::abs(a[i] - e.a) < 1e-12);
          CHECK(std::abs(reaction[i] - (3.0 * a[i] - spring[i])) < 1e-10);
        }
        CHECK(r.result.statistics.energy_residual < 1e-3 * r.result.statistics.energy_exchanged);
      }
}

TEST_CASE("angle and distance follow their signals") {
  const Run angle = run(driven("angle", "velocity", "\"body\"", 0.0), {"rk4", 1e-2, 2.0, 0.07});
  for (std::size_t i = 0; i < angle.times().size(); ++i) {
    const Jet e = expected("velocity", angle.times()[i], 0.0);
    CHECK(std::abs(angle.series("body.theta")[i] - e.x) < 1e-13);
    CHECK(std::abs(angle.series("body.omega")[i] - e.v) < 1e-13);
    CHECK(std::abs(angle.series("drive.reaction")[i] - (0.6 * e.a + 30.0 * e.x + 0.5 * e.v)) < 1e-11);
  }
  const Run distance = run(R"(
gravity = [0.0, 0.0]
[[signal]]
name = "reel"
kind = "harmonics"
amplitudes = [0.3]
frequencies = [1.5]
phases = [-1.5707963267948966]
[[body]]
name = "ball"
mass = 1.0
inertia = 1.0
position = [0.6, 0.8]
velocity = [-1.6, 1.2]
[[element]]
kind = "prescribed_motion"
name = "rope"
a = "ball"
coordinate = "distance"
signal = "reel"
as = "velocity"
)",
                           {"dop853", 1e-12, 2.0, 0.1});
  // Reeled in and out about the origin: the angular momentum r²φ̇ = 2 stays.
  for (std::size_t i = 0; i < distance.times().size(); ++i) {
    const double x = distance.series("ball.x")[i], y = distance.series("ball.y")[i];
    const double r = 1.0 + 0.3 / k_w * (1.0 - std::cos(k_w * distance.times()[i]));
    CHECK(std::abs(std::hypot(x, y) - r) < 1e-11);
    CHECK(std::abs(x * distance.series("ball.vy")[i] - y * distance.series("ball.vx")[i] - 2.0) < 1e-10);
    const double rate = 0.3 * k_w * std::cos(k_w * distance.times()[i]);
    CHECK(std::abs(distance.series("rope.reaction")[i] - (rate - 4.0 / (r * r * r))) < 1e-8);
  }
}

TEST_CASE("the work of a drive is what its reaction does: the energy account closes") {
  for (const std::string at : {"\"body\"", "{ body = \"body\", point = [0.0, 0.1] }"}) {
    const Run r = run(driven("x", "velocity", at, 0.0), {"dop853", 1e-12, 2.0, 0.05});
    CHECK(r.result.statistics.energy_residual < 1e-9 * r.result.statistics.energy_exchanged);
    CHECK(std::abs(r.result.statistics.work) > 0.0);
  }
}

namespace {

bool is_refused(const std::string& text) {
  const Model model = scene(text + "\n[simulation]\nstep = 1e-3\n");
  try {
    static_cast<void>(compile(model));
  } catch (const ModelError&) {
    return true;
  }
  return false;
}

} // namespace

TEST_CASE("a position is absolute, or counts from the reference pose; neither makes the body jump") {
  const auto moved = [](const std::string& place, const std::string& more) {
    return std::string("[[signal]]\nname = \"swing\"\nkind = \"harmonics\"\namplitudes = [0.2]\nfrequencies = [1.5]\n"
                       "phases = [-1.5707963267948966]\n[[body]]\nname = \"body\"\nmass = 3.0\ninertia = 0.6\n") +
           place + "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"body\"\nsignal = \"swing\"\n" + more;
  };
  const std::string absolute = "as = \"position\"\n", counted = absolute + "zero = \"reference\"\n";
  const std::string away = "position = [7.0, 0.0]\nangle = 0.5\n", at_origin = "position = [0.0, 0.0]\n";
  for (const std::string coordinate : {"x", "angle"}) {
    CAPTURE(coordinate);
    const std::string along = "coordinate = \"" + coordinate + "\"\n";
    CHECK(is_refused(moved(away, along + absolute)));
    CHECK_FALSE(is_refused(moved(at_origin, along + absolute)));
    CHECK_FALSE(is_refused(moved(away, along + counted)));
    const Run whole = run(moved(at_origin, along + absolute), {"dop853", 1e-9, 0.2});
    const Run beyond = run(moved(away, along + counted), {"dop853", 1e-9, 0.2});
    const std::string channel = coordinate == "x" ? "body.x" : "body.theta";
    const double wanted = 0.2 * std::sin(0.2 * k_w);
    CHECK(std::abs(whole.last(channel) - wanted) < 1e-12);
    CHECK(std::abs(beyond.last(channel) - (coordinate == "x" ? 7.0 : 0.5) - wanted) < 1e-12);
  }
  // A signal that does not begin with zero would make it jump from there, too.
  CHECK(is_refused(driven("x", "position", "\"body\"", 0.0) + "zero = \"reference\"\n"));
  // One made in C++, and one of which a study has changed a number, are compiled like those that are read.
  Model model = scene(moved(at_origin, absolute) + "[simulation]\nstep = 1e-3\n");
  CHECK_NOTHROW(static_cast<void>(compile(model)));
  model.bodies[0].position.x() = 7.0;
  try {
    static_cast<void>(compile(model));
    FAIL("the body jumps");
  } catch (const ModelError& error) {
    CHECK(std::string(error.what()).find("the reference pose has 7 m where the motion begins with 0 m at t = 0") != std::string::npos);
  }
  CHECK_THROWS_AS((void)run(driven("x", "velocity", "\"body\"", 0.0) + "zero = \"reference\"\n", {"dop853", 1e-9, 0.2}), ModelError);
}
