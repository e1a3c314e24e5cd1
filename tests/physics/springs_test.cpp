// Springs, dampers and bushings against the closed form of the damped oscillator.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// m q̈ + c q̇ + k q = 0 from q(0) = q0, q̇(0) = v0, underdamped.
struct FreeDecay {
  double m, c, k, q0, v0;
  [[nodiscard]] double at(double t) const {
    const double s = 0.5 * c / m, w = std::sqrt(k / m - s * s);
    return std::exp(-s * t) * (q0 * std::cos(w * t) + (v0 + s * q0) / w * std::sin(w * t));
  }
};

// Tolerance 1e-12 a step, some hundred steps, no growth of errors in a decaying motion.
constexpr double k_tolerance = 1e-10;

void check_decay(const Run& r, const std::string& channel, const FreeDecay& exact) {
  const std::vector<double> q = r.series(channel);
  for (std::size_t i = 0; i < q.size(); ++i) CHECK(std::abs(q[i] - exact.at(r.times()[i])) < k_tolerance * std::abs(exact.q0));
}

} // namespace

TEST_CASE("mass on a spring-damper decays as the closed form says") {
  const char* text = R"(
gravity = [0.0, 0.0]
[[body]]
name = "mass"
mass = 2.0
inertia = 1.0
position = [0.1, 0.0]
velocity = [-0.3, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
stiffness = 25.0
damping = 0.6
count = 2
free_length = 0.0
)";
  const Run r = run(text, {"dop853", 1e-12, 10.0, 0.1});
  check_decay(r, "mass.x", {2.0, 1.2, 50.0, 0.1, -0.3});
  CHECK(r.result.statistics.energy_residual < 1e-11 * r.result.statistics.energy_exchanged);
}

TEST_CASE("a mass hanging on a point-to-point spring finds its preload's equilibrium and swings about it") {
  // Vertical motion only: the length is the height. Preload = weight: the reference pose is at rest.
  const char* text = R"(
[[body]]
name = "mass"
mass = 3.0
inertia = 1.0
position = [0.0, -2.0]
velocity = [0.0, 0.4]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
stiffness = 120.0
damping = 2.0
preload = -29.43
)";
  const Run r = run(text, {"dop853", 1e-12, 5.0, 0.1});
  const FreeDecay exact{3.0, 2.0, 120.0, 0.0, 0.4};
  const std::vector<double> y = r.series("mass.y"), x = r.series("mass.x");
  for (std::size_t i = 0; i < y.size(); ++i) {
    CHECK(std::abs(y[i] + 2.0 - exact.at(r.times()[i])) < 1e-11);
    CHECK(x[i] == 0.0);
  }
}

// A mass on a vertical line between two springs that lead to both sides of the plane: with L = √(y² + c²) each stores ½ k (L − L₀)².
TEST_CASE("springs that leave the plane keep the energy of springs in space, pull and push") {
  const double m = 2.0, k = 300.0, c = 0.6, free = 0.9, y_0 = -0.9;
  const auto text = [](const std::string& more) {
    return std::string("gravity = [0.0, 0.0]\n") + "[[body]]\nname = \"mass\"\nmass = 2.0\ninertia = 1.0\nposition = [0.0, -0.9]\n" +
           "[[element]]\nkind = \"spring_damper\"\nname = \"pair\"\na = \"mass\"\nstiffness = 300.0\nacross = 0.6\ncount = 2\n" + more;
  };
  const auto energy = [&](double y) { return k * std::pow(std::hypot(y, c) - free, 2); };
  const Run r = run(text("free_length = 0.9\n"), {"dop853", 1e-12, 2.0, 0.05});
  const std::vector<double> y = r.series("mass.y"), v = r.series("mass.vy"), force = r.series("pair.force");
  bool pulls = false, pushes = false;
  for (std::size_t i = 0; i < y.size(); ++i) {
    CHECK(std::abs(0.5 * m * v[i] * v[i] + energy(y[i]) - energy(y_0)) < 1e-9 * energy(y_0)); // 2 s, tolerance 1e-12 a step
    CHECK(std::abs(force[i] + 2.0 * k * (std::hypot(y[i], c) - free)) < 1e-9 * k);            // of both, along them
    pulls |= force[i] < -1.0;
    pushes |= force[i] > 1.0;
  }
  CHECK(pulls);
  CHECK(pushes);
  // Without a free length they are at rest as they are drawn, which is a length in space.
  CHECK(run(text(""), {"dop853", 1e-12, 0.1}).last("mass.vy") == 0.0);
  CHECK_THROWS_AS((void)run(text("axis = [0.0, 1.0]\n"), {}), ModelError);
}

TEST_CASE("a rotational spring-damper turns a body as the closed form says") {
  const char* text = R"(
gravity = [0.0, 0.0]
[[body]]
name = "wheel"
mass = 2.0
inertia = 0.5
angle = 0.2
angular_velocity = 1.0
[[element]]
kind = "rotational_spring_damper"
name = "spring"
a = "wheel"
stiffness = 18.0
damping = 0.3
free_angle = 0.0
)";
  check_decay(run(text, {"dop853", 1e-12, 10.0, 0.1}), "wheel.theta", {0.5, 0.3, 18.0, 0.2, 1.0});
}

TEST_CASE("a bushing at the centre of gravity is three oscillators, in the axes of its marker") {
  // The marker's axes are turned by 0.3: the displacement from the start runs along its x axis.
  const char* text = R"(
gravity = [0.0, 0.0]
[[body]]
name = "block"
mass = 4.0
inertia = 0.8
velocity = [0.47766824456280304, 0.14776010333066977]
angular_velocity = 0.7
[[marker]]
name = "seat"
body = "ground"
at = [0.0, 0.0]
angle = 0.3
[[element]]
kind = "bushing"
name = "bushing"
a = "block"
b = "seat"
stiffness = [300.0, 900.0]
damping = [2.0, 3.0]
rotational_stiffness = 40.0
rotational_damping = 0.4
)";
  const Run r = run(text, {"dop853", 1e-12, 5.0, 0.1});
  const FreeDecay along{4.0, 2.0, 300.0, 0.0, 0.5}, turn{0.8, 0.4, 40.0, 0.0, 0.7};
  const std::vector<double> x = r.series("block.x"), y = r.series("block.y"), theta = r.series("block.theta");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = r.times()[i];
    CHECK(std::abs(x[i] - std::cos(0.3) * along.at(t)) < 1e-11);
    CHECK(std::abs(y[i] - std::sin(0.3) * along.at(t)) < 1e-11);
    CHECK(std::abs(theta[i] - turn.at(t)) < 1e-11);
  }
}

TEST_CASE("a spring with a dead band is free inside it and an oscillator beyond") {
  // Half a gap at v, half a period of the oscillator, the gap backwards, and so on; no damping.
  const char* text = R"(
gravity = [0.0, 0.0]
[[body]]
name = "mass"
mass = 2.0
inertia = 1.0
velocity = [0.5, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
stiffness = 800.0
free_length = 0.0
gap = 0.2
)";
  for (const Settings& settings : {Settings{"dop853", 1e-12, 6.0}, Settings{"rk4", 1e-3, 6.0}}) {
    const Run r = run(text, settings);
    const double half_period = std::acos(-1.0) / 20.0, crossing = 0.2 / 0.5;
    const std::vector<double> closes = r.event_times("spring", "closes its gap"), enters = r.event_times("spring", "enters its gap");
    REQUIRE(closes.size() == 11); // at 0.2 s and every half period and crossing after it
    REQUIRE(enters.size() == 11);
    for (std::size_t i = 0; i < closes.size(); ++i) {
      const double t = 0.2 + static_cast<double>(i) * (crossing + half_period);
      // rk4: ωh = 0.02, (ωh)⁴/120 of each half period; dop853: errors of eleven passages add up
      const double tolerance = settings.integrator == "rk4" ? 1e-8 : 5e-11;
      CHECK(std::abs(closes[i] - t) < tolerance);
      CHECK(std::abs(enters[i] - t - half_period) < tolerance);
    }
  }
}

TEST_CASE("a tabulated spring and damper with one slope is the linear one; kinks are events") {
  const auto text = [](const char* law) {
    return std::string(R"(
gravity = [0.0, 0.0]
[[body]]
name = "mass"
mass = 2.0
inertia = 1.0
position = [0.3, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
free_length = 0.0
)") + law;
  };
  const Run linear = run(text("stiffness = 50.0\ndamping = 1.2\n"), {"dop853", 1e-12, 3.0, 0.1});
  const Run table = run(text("force_table = [[-1.0, -50.0], [0.1, 5.0], [1.0, 50.0]]\n"
                             "damping_table = [[-1.0, -1.2], [1.0, 1.2]]\n"),
                        {"dop853", 1e-12, 3.0, 0.1});
  for (std::size_t i = 0; i < linear.times().size(); ++i) CHECK(std::abs(linear.series("mass.x")[i] - table.series("mass.x")[i]) < 1e-11);
  CHECK(!table.event_times("spring").empty());

  // Four times as stiff below zero: half periods of π/5 and π/10 alternate, energy is kept.
  const Run kinked = run(text("force_table = [[-1.0, -200.0], [0.0, 0.0], [1.0, 50.0]]\n"), {"dop853", 1e-12, 3.0});
  const std::vector<double> kinks = kinked.event_times("spring");
  const double soft = std::acos(-1.0) / 5.0, stiff = std::acos(-1.0) / 10.0;
  REQUIRE(kinks.size() >= 3);
  CHECK(std::abs(kinks[0] - 0.5 * soft) < 1e-11);
  CHECK(std::abs(kinks[1] - 0.5 * soft - stiff) < 1e-11);
  CHECK(std::abs(kinks[2] - 1.5 * soft - stiff) < 1e-11);
  CHECK(kinked.result.statistics.energy_residual < 1e-10);
}

TEST_CASE("a spring given by the frequency and damping ratio of its mass decays as that oscillator") {
  const double m = 2.0, frequency = 1.5, ratio = 0.07, omega = 2.0 * 3.14159265358979323846 * frequency;
  const char* text = R"(
gravity = [0.0, 0.0]
[[body]]
name = "mass"
mass = 2.0
inertia = 1.0
position = [0.1, 0.0]
velocity = [-0.3, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
carries = "2 kg"
frequency = 1.5
damping_ratio = 0.07
count = 3
free_length = 0.0
)";
  const Run r = run(text, {"dop853", 1e-12, 5.0, 0.1});
  check_decay(r, "mass.x", {m, 2.0 * ratio * m * omega, m * omega * omega, 0.1, -0.3});
}

namespace {

std::string spring_of(const std::string& fields) {
  return "[[body]]\nname = \"mass\"\nmass = 500.0\ninertia = 1.0\n[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = "
         "\"mass\"\naxis = [0.0, 1.0]\n" +
         fields;
}

std::string refusal(const std::string& fields) {
  try {
    (void)compile(scene(spring_of(fields)));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

} // namespace

// Two pads of densified wood, 4.3 GPa · 0.04 m²/0.05 m each, and a damping ratio of the mass on them.
TEST_CASE("pads are as stiff as their material, area and thickness") {
  const double k = 2.0 * 4.3e9 * 0.04 / 0.05, m = 500.0, c = 2.0 * 0.05 * std::sqrt(k * m);
  const Run r =
      run("gravity = [0.0, 0.0]\n" + spring_of("material = \"densified wood\"\narea = \"0.04 m2\"\nthickness = \"50 mm\"\ncount = 2\n"
                                               "carries = 500\ndamping_ratio = 0.05\nfree_length = -0.001\n"),
          {"dop853", 1e-12, 0.01, 1e-3});
  const std::vector<double> y = r.series("mass.y");
  const FreeDecay exact{m, c, k, 0.001, 0.0};
  // The frequency of 590 Hz for 6 swings: as in check_decay().
  for (std::size_t i = 0; i < y.size(); ++i) CHECK(std::abs(y[i] + 0.001 - exact.at(r.times()[i])) < 10.0 * k_tolerance * 0.001);
  const std::string foot = "[[body]]\nname = \"box\"\nmass = 500.0\ninertia = 1.0\n[[element]]\nkind = \"unilateral_contact\"\nname = "
                           "\"foot\"\na = \"box\"\ngap = 0.0\n";
  for (const char* fields : {"material = \"rubber\"\narea = 0.02\nthickness = 0.04\ncount = 2\n", "stiffness = 2e6\ncount = 2\n"}) {
    const Run pressed = run("gravity = [0.0, -9.81]\n" + foot + fields, {"dop853", 1e-12, 0.02});
    const double omega = std::sqrt(4e6 / m), t = 0.02; // of 4 MPa · 0.02 m²/0.04 m, twice
    CHECK(pressed.last("box.y") == doctest::Approx(-9.81 / (omega * omega) * (1.0 - std::cos(omega * t))).epsilon(1e-9));
  }
}

TEST_CASE("springs and pads that say too little or too much are refused") {
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  CHECK(has(refusal("frequency = 2\n"), "give it as 'carries'"));
  CHECK(has(refusal("carries = 5\nstiffness = 1\n"), "'carries' goes with"));
  CHECK(has(refusal("carries = 5\nfrequency = 2\nstiffness = 1\n"), "give either 'frequency' or a stiffness"));
  CHECK(has(refusal("carries = 5\nfrequency = 2\ndamping = 1\ndamping_ratio = 0.1\n"), "give either 'damping_ratio' or a damping"));
  CHECK(has(refusal("carries = 5\ndamping_ratio = 0.1\n"), "'damping_ratio' needs"));
  CHECK(has(refusal("material = \"rubber\"\narea = 1\n"), "needs 'area' and 'thickness'"));
  CHECK(has(refusal("material = \"rubber\"\narea = 1\nthickness = 1\nstiffness = 1\n"), "not both"));
  CHECK(has(refusal("area = 1\nstiffness = 1\n"), "give its 'material'"));
  CHECK(has(refusal("material = \"ruber\"\narea = 1\nthickness = 1\n"), "one of"));
}
