// joint_friction whose bound follows a signal, hangs on the velocity, or both: brakes, clutches, seals. All motions here are closed
// forms.
#include "tests/physics/stepped.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};

std::string wheel(const std::string& name, double inertia, double speed) {
  return "[[body]]\nname = \"" + name + "\"\nmass = 1.0\ninertia = " + std::to_string(inertia) +
         "\nangular_velocity = " + std::to_string(speed) + "\n[[element]]\nkind = \"revolute\"\nname = \"bearing of " + name +
         "\"\na = \"" + name + "\"\n";
}

std::string friction(const std::string& fields) {
  return "[[element]]\nkind = \"joint_friction\"\nname = \"brake\"\na = \"wheel\"\n" + fields;
}

const std::string k_block = R"(
[[body]]
name = "block"
mass = 2.0
inertia = 1.0
)";
const std::string k_guide = R"(
[[element]]
kind = "prismatic"
name = "guide"
a = "block"
axis = [1.0, 0.0]
[[element]]
kind = "joint_friction"
name = "seal"
a = "block"
coordinate = "x"
)";

std::string push(double force) {
  return "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"block\"\nforce = [" + std::to_string(force) + ", 0.0]\n";
}

// What an integration at 1e-11 leaves of 10 rad/s after some events.
constexpr double k_close = 1e-8;

} // namespace

TEST_CASE("a brake whose pressure grows stops a wheel where its work is the wheel's energy") {
  // J ω' = −D t/T for t < T, −D after that: ω = 0 at T/2 + J ω₀/D.
  const double inertia = 0.5, speed = 10.0, drags = 8.0, rise = 0.2;
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r =
        run(wheel("wheel", inertia, speed) +
                "[[signal]]\nkind = \"trapezoid\"\nname = \"pressure\"\npeak = 1.0\nstart = 0.0\nduration = 6.0\nrise = 0.2\nfall = 1.0\n" +
                friction("holds = 10.0\ndrags = 8.0\nsignal = \"pressure\"\n"),
            {method, 1e-11, 2.0});
    const std::vector<double> stops = r.event_times("brake", "sticks");
    REQUIRE(stops.size() == 1);
    CHECK(std::abs(stops[0] - (0.5 * rise + inertia * speed / drags)) < k_close);
    CHECK(r.last("wheel.omega") == 0.0);
    CHECK(r.last("brake.mode") == 1.0);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * inertia * speed * speed) < k_close * 25.0);
  }
}

TEST_CASE("a clutch that is closed at once brings two wheels to one speed") {
  // Before: free. After: they near each other with D (1/J₁ + 1/J₂), and keep their angular momentum.
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(wheel("wheel", 0.5, 12.0) + wheel("other", 1.5, 0.0) +
                          "[[signal]]\nkind = \"rectangle\"\nname = \"pressure\"\npeak = 1.0\nstart = 0.25\nduration = 9.0\n" +
                          friction("b = \"other\"\nholds = 10.0\ndrags = 9.0\nsignal = \"pressure\"\n"),
                      {method, 1e-11, 2.0, 0.125});
    CHECK(r.series("wheel.omega")[1] == doctest::Approx(12.0).epsilon(1e-14)); // at 0.125 s nothing has touched it
    CHECK(r.series("brake.mode")[1] == 0.0);
    const std::vector<double> locks = r.event_times("brake", "sticks");
    REQUIRE(locks.size() == 1);
    CHECK(std::abs(locks[0] - (0.25 + 12.0 / (9.0 * (1.0 / 0.5 + 1.0 / 1.5)))) < k_close);
    CHECK(std::abs(r.last("wheel.omega") - 3.0) < k_close);
    CHECK(std::abs(r.last("other.omega") - 3.0) < k_close);
  }
}

TEST_CASE("a brake that is let go slips when its pressure holds no more, to the digit, and is free in the end") {
  // Held by 10 s(t), s = 1 − t, against a couple of 4: slips at 0.6 s; then J ω' = 4 − 6 s until s = 0, then 4.
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(wheel("wheel", 0.5, 0.0) +
                          "[[element]]\nkind = \"load\"\nname = \"couple\"\nat = \"wheel\"\ncouple = 4.0\n"
                          "[[signal]]\nkind = \"triangle\"\nname = \"pressure\"\npeak = 1.0\nstart = -1.0\nduration = 2.0\n" +
                          friction("holds = 10.0\ndrags = 6.0\nsignal = \"pressure\"\n"),
                      {method, 1e-11, 2.0});
    const std::vector<double> slips = r.event_times("brake", "slips forward");
    REQUIRE(slips.size() == 1);
    CHECK(std::abs(slips[0] - 0.6) < 1e-12); // the bound is a line: its crossing is known to rounding
    CHECK(std::abs(r.last("wheel.omega") - (4.0 * 1.4 - 6.0 * 0.5 * 0.4 * 0.4) / 0.5) < k_close);
    CHECK(r.last("brake.mode") == 0.0);
    CHECK(r.last("brake.friction") == 0.0);
  }
}

TEST_CASE("with a viscous part a pushed block nears its last speed as an exponential does") {
  // m v' = F − D − c v.
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(k_block + k_guide + "holds = 5.0\ndrags = 3.0\nviscous = 4.0\n" + push(11.0), {method, 1e-11, 1.0});
    CHECK(std::abs(r.last("block.vx") - 8.0 / 4.0 * (1.0 - std::exp(-4.0 / 2.0 * 1.0))) < k_close);
  }
}

TEST_CASE("Stribeck's friction: a coasting block stops when the integral of m/f says so") {
  // f = D + (H − D)/(1 + u²), u = v/v_s: t = m v_s ∫ (1 + u²)/(H + D u²) du.
  const double holds = 6.0, drags = 2.0, stribeck = 0.3, speed = 1.5, mass = 2.0;
  const double u = speed / stribeck, root = std::sqrt(holds * drags);
  const double stop = mass * stribeck * (u / drags + (1.0 - holds / drags) / root * std::atan(u * std::sqrt(drags / holds)));
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r =
        run(k_block + "velocity = [1.5, 0.0]\n" + k_guide + "holds = 6.0\ndrags = 2.0\nstribeck_velocity = 0.3\n", {method, 1e-11, 2.0});
    const std::vector<double> stops = r.event_times("seal", "sticks");
    REQUIRE(stops.size() == 1);
    CHECK(std::abs(stops[0] - stop) < k_close);
    CHECK(r.last("block.vx") == 0.0);
  }
}

TEST_CASE("load and brake that one signal begins: it slips from there on, also where another element's event cuts the first step") {
  // Pushed by 17 s, held by 9 s and dragged by 8 s: m v = 9 ∫ s. At the beginning all are zero, and nothing holds a hair later.
  const std::string pushed =
      k_block + k_guide +
      "holds = 9.0\ndrags = 8.0\nsignal = \"s\"\n[[signal]]\nkind = \"triangle\"\nname = \"s\"\npeak = 1.0\nstart = 0.3\nduration = 1.0\n"
      "[[signal]]\nkind = \"scaled\"\nname = \"f\"\nsignal = \"s\"\nfactor = 17.0\n"
      "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"block\"\nforce_x = \"f\"\n";
  for (int i = 0; i < 40; ++i) {
    // A second mass meets a spring some time after the beginning, sooner or later than the first step would have ended.
    const double meets = 0.3 + 0.05 * std::pow(10.0, -0.1 * i);
    const std::string other =
        "[[body]]\nname = \"other\"\nmass = 1.0\ninertia = 1.0\nposition = [0.0, 9.0]\nvelocity = [-1.0, 0.0]\n"
        "[[element]]\nkind = \"unilateral_contact\"\nname = \"stop\"\na = \"other\"\nnormal = [1.0, 0.0]\nstiffness = 1e4\ngap = " +
        std::to_string(meets) + "\n";
    for (const char* method : k_methods) {
      CAPTURE(method);
      CAPTURE(meets);
      const Run r = run("gravity = [0.0, 0.0]\n" + pushed + other, {method, 1e-9, 0.8});
      CHECK(std::abs(r.last("block.vx") - 9.0 * 0.25 / 2.0) < 1e-7);
    }
  }
}

TEST_CASE("time stepping brakes as the methods that follow events do, with the error of its order") {
  const std::string text =
      wheel("wheel", 0.5, 10.0) +
      "[[signal]]\nkind = \"trapezoid\"\nname = \"pressure\"\npeak = 1.0\nstart = 0.1\nduration = 6.0\nrise = 0.2\nfall = 1.0\n" +
      friction("holds = 10.0\ndrags = 6.0\nstribeck_velocity = 2.0\nviscous = 0.1\nsignal = \"pressure\"\n");
  const Run exact = run(text, {"dop853", 1e-12, 0.5});
  double before = 0.0;
  for (const double step : {1e-3, 1e-4, 1e-5}) {
    const double error = std::abs(stepped(text, step, 0.5).last("wheel.omega") - exact.last("wheel.omega"));
    CHECK(error < 20.0 * step); // of the first order; 10 rad/s are gone in half a second
    if (before > 0.0) CHECK(error < 0.3 * before);
    before = error;
  }
}

TEST_CASE("a pressure that swings between zero and twice its mean takes from a wheel what its integral says") {
  // 1 + cos touches zero once a period, without a corner: J Δω = D ∫ (1 + cos) dt.
  const std::string swinging =
      "[[signal]]\nkind = \"harmonics\"\nname = \"pressure\"\nfrequencies = [2.0]\namplitudes = [1.0]\noffset = 1.0\n";
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r =
        run(wheel("wheel", 0.5, 30.0) + swinging + friction("holds = 8.0\ndrags = 6.0\nsignal = \"pressure\"\n"), {method, 1e-11, 1.75});
    CHECK(std::abs(r.last("wheel.omega") - (30.0 - 6.0 / 0.5 * 1.75)) < k_close); // at the end of half a period the sine is zero
  }
}

TEST_CASE("what cannot be is refused") {
  const auto text = [](const std::string& fields) { return k_block + k_guide + fields + "[simulation]\nstep = 1e-3\n"; };
  CHECK_THROWS_AS((void)compile(scene(text("holds = 5.0\nstribeck_velocity = 0.1\n"))), ModelError);
  CHECK_THROWS_AS((void)scene(text("holds = 5.0\ndrags = 2.0\nstribeck_velocity = 0.0\n")), ModelError);
  CHECK_THROWS_AS((void)scene(text("holds = 5.0\nviscous = -1.0\n")), ModelError);
  CHECK_THROWS_AS((void)compile(scene(text("holds = 5.0\nsignal = \"nobody\"\n"))), ModelError);
  const auto pressed = [&](const std::string& harmonics) {
    (void)compile(scene(text("holds = 5.0\nsignal = \"s\"\n[[signal]]\nkind = \"harmonics\"\nname = \"s\"\n" + harmonics)));
  };
  CHECK_THROWS_AS(pressed("frequencies = [40.0]\namplitudes = [1.0]\noffset = 0.9999999\n"), ModelError); // by a hair
  CHECK_THROWS_AS(pressed("frequencies = [1.0, 7.3]\namplitudes = [1.0, 0.3]\noffset = 1.2\n"), ModelError);
  CHECK_NOTHROW(pressed("frequencies = [40.0]\namplitudes = [1.0]\noffset = 1.0\n"));
  // Of pieces without harmonics the least value is a corner or where the slope is zero, wherever that lies.
  const auto table = [&](double low) {
    (void)compile(scene(text("holds = 5.0\nsignal = \"s\"\n[[signal]]\nkind = \"trapezoid\"\nname = \"up\"\npeak = 1.0\nduration = "
                             "0.7\nrise = 0.1\nfall = 0.013\n"
                             "[[signal]]\nkind = \"scaled\"\nname = \"s\"\nsignal = \"up\"\nfactor = -1.0\noffset = " +
                             std::to_string(low) + "\n")));
  };
  CHECK_THROWS_AS(table(0.999999), ModelError);
  CHECK_NOTHROW(table(1.0));
}
