// Small vibrations: closed forms, and a run that starts along a mode's shape.
#include "mbd/rest/equilibrium.h"
#include "mbd/rest/modes.h"
#include "tests/physics/paper_runs.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Jacobians are exact, eigenvalues good to rounding times the spread of the frequencies' squares.
constexpr double k_digits = 1e-9;

std::string exact(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

// The paper's file with more at its end.
Model paper_scene_with(const std::string& more, const std::vector<std::string>& overrides) {
  std::ifstream file(std::string(STEPLAP_MODELS) + "/paper/no_interference.toml");
  std::ostringstream text;
  text << file.rdbuf() << more;
  return parse_model(text.str(), "scene.toml", transformer_catalog(), overrides);
}

VibrationModes modes_of(const std::string& text) {
  const auto system = compile(parse_model(text, "scene.toml", transformer_catalog()));
  return vibration_modes(*system, find_equilibrium(*system, system->initial_state()).state);
}

const char* k_guided_mass = R"(
[simulation]
step = 1e-3
[[body]]
name = "mass"
mass = 4.0
inertia = 1.0
position = [0.0, 0.0]
[[element]]
kind = "prismatic"
name = "guide"
a = "mass"
axis = [0.0, 1.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [0.0, 1.0]
stiffness = 400.0
)";

} // namespace

TEST_CASE("a mass on a spring and damper vibrates as the textbook says") {
  const VibrationModes found = modes_of(std::string(k_guided_mass) + "damping = 8.0\n");
  REQUIRE(found.modes.size() == 1);
  CHECK(found.rigid_motions == 0);
  const double omega = std::sqrt(400.0 / 4.0), zeta = 8.0 / (2.0 * 4.0 * omega);
  // One exact Jacobian and a 2 × 2 eigenproblem: rounding.
  CHECK(std::abs(found.modes[0].natural_frequency() - omega / (2.0 * std::numbers::pi)) < 1e-13);
  CHECK(std::abs(found.modes[0].damping_ratio() - zeta) < 1e-14);
  CHECK(std::abs(found.modes[0].shape[4] - 1.0) < 1e-14); // y of body 1
}

TEST_CASE("an overdamped mass has two real decays, a free one a rigid motion") {
  const VibrationModes slow = modes_of(std::string(k_guided_mass) + "damping = 200.0\n");
  REQUIRE(slow.modes.size() == 2);
  const double root = std::sqrt(25.0 * 25.0 - 100.0); // c/2m = 25 /s
  CHECK(std::abs(slow.modes[0].eigenvalue - (-25.0 + root)) < 1e-12);
  CHECK(std::abs(slow.modes[1].eigenvalue - (-25.0 - root)) < 1e-12);
  const VibrationModes free =
      modes_of("gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n[[body]]\nname = \"mass\"\nmass = 4.0\ninertia = 1.0\n");
  CHECK(free.modes.empty());
  CHECK(free.rigid_motions == 3);
}

TEST_CASE("a compound pendulum about its pin") {
  const VibrationModes found = modes_of(R"(
[simulation]
step = 1e-3
[[body]]
name = "rod"
mass = 3.0
inertia = 0.25
position = [0.0, -0.5]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "rod", at = [0.0, 0.0] }
b = { body = "ground", at = [0.0, 0.0] }
)");
  REQUIRE(found.modes.size() == 1);
  const double omega = std::sqrt(3.0 * 9.81 * 0.5 / (0.25 + 3.0 * 0.25));
  CHECK(std::abs(found.modes[0].natural_frequency() * 2.0 * std::numbers::pi / omega - 1.0) < 1e-12);
  CHECK(std::abs(found.modes[0].damping_ratio()) < 1e-12);
}

namespace {

// n masses of 2.5 kg on guides between two walls, springs of 900 N/m between them.
std::string long_chain(int n) {
  std::string text = "gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n";
  const auto link = [&text](int i, const std::string& a, const std::string& b) {
    text += "[[element]]\nkind = \"spring_damper\"\nname = \"spring " + std::to_string(i) + "\"\na = " + a + "\nb = " + b +
            "\naxis = [1.0, 0.0]\nstiffness = 900.0\n";
  };
  for (int i = 1; i <= n; ++i) {
    const std::string name = "\"m" + std::to_string(i) + "\"";
    text += "[[body]]\nname = " + name + "\nmass = 2.5\ninertia = 1.0\nposition = [" + std::to_string(i) + ".0, 0.0]\n";
    text += "[[element]]\nkind = \"prismatic\"\nname = \"guide " + std::to_string(i) + "\"\na = " + name + "\n";
    link(i, name, i == 1 ? "\"ground\"" : "\"m" + std::to_string(i - 1) + "\"");
  }
  link(n + 1, "\"m" + std::to_string(n) + "\"", "{ body = \"ground\", at = [" + std::to_string(n + 1) + ".0, 0.0] }");
  return text;
}
double chain_rate(int n, int k) { return 2.0 * std::sqrt(900.0 / 2.5) * std::sin(k * std::numbers::pi / (2.0 * (n + 1))); }

} // namespace

// n masses between two walls: ω_k = 2 √(k/m) sin(kπ/(2(n+1))).
TEST_CASE("a chain of masses and springs between two walls") {
  constexpr int n = 12;
  const VibrationModes found = modes_of(long_chain(n));
  REQUIRE(found.modes.size() == n);
  for (int k = 1; k <= n; ++k) {
    const double omega = chain_rate(n, k);
    CHECK(std::abs(2.0 * std::numbers::pi * found.modes[k - 1].natural_frequency() / omega - 1.0) < k_digits);
  }
}

// Hencky's bar chain, simply supported: N rods of length a, mass m, inertia J, joints of rotational stiffness C.
// On the sine modes of the joints, w_j = sin(kπj/N), with φ = kπ/N,
//   stiffness 16 C/a² sin⁴(φ/2) against mass m cos²(φ/2) + 4 J/a² sin²(φ/2).
TEST_CASE("a beam of rods with springs in their joints") {
  constexpr int rods = 10;
  constexpr double length = 0.2, mass = 0.7, inertia = mass * length * length / 12.0, stiffness = 1300.0;
  std::string text = "gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n";
  for (int i = 0; i < rods; ++i) {
    const std::string name = "rod " + std::to_string(i), before = "rod " + std::to_string(i - 1);
    const std::string a = "a = { body = \"" + name + "\", point = [-0.1, 0.0] }\n";
    const std::string b = i == 0 ? "" : "b = { body = \"" + before + "\", point = [0.1, 0.0] }\n";
    text += "[[body]]\nname = \"" + name + "\"\nmass = 0.7\ninertia = " + exact(inertia) + "\n";
    text += "[[element]]\nkind = \"revolute\"\nname = \"pin " + std::to_string(i) + "\"\n" + a + b + "angle = 0.0\n";
    if (i > 0)
      text += "[[element]]\nkind = \"bushing\"\nname = \"joint " + std::to_string(i) + "\"\n" + a + b + "rotational_stiffness = 1300.0\n";
  }
  text += "[[element]]\nkind = \"point_on_line\"\nname = \"roller\"\na = { body = \"rod 9\", point = [0.1, 0.0] }\n";
  const VibrationModes found = modes_of(text);
  REQUIRE(found.modes.size() == rods - 1);
  for (int k = 1; k < rods; ++k) {
    const double s = std::sin(0.5 * k * std::numbers::pi / rods), c = std::cos(0.5 * k * std::numbers::pi / rods);
    const double omega =
        std::sqrt(16.0 * stiffness / (length * length) * s * s * s * s / (mass * c * c + 4.0 * inertia / (length * length) * s * s));
    CHECK(std::abs(2.0 * std::numbers::pi * found.modes[k - 1].natural_frequency() / omega - 1.0) < k_digits);
  }
}

// All bodies of the paper's scene welded into one on its suspension, x driven by the brake: bounce and pitch.
// In y and θ of the lower tank, with c the centre of gravity of all and (±l, h) the springs' feet seen from there,
// F = m g/2 what each bears,
//   M = (m, m c_x; m c_x, J + m |c|²),  K = (2 k, 0; 0, 2 k l² + 2 F h − m g c_y).
TEST_CASE("the paper's transformer as one rigid body bounces and pitches on its suspension") {
  std::string welds;
  for (const char* body : {"active part", "front limb", "back limb", "upper tank"})
    welds += "[[element]]\nkind = \"weld\"\nname = \"" + std::string(body) + " welded\"\na = \"" + body + "\"\nb = \"lower tank\"\n";
  const Model model = paper_scene_with(welds, {"element.front suspension.damping=0", "element.rear suspension.damping=0"});
  const auto system = compile(model);
  const VibrationModes found = vibration_modes(*system, find_equilibrium(*system, system->initial_state()).state);
  const Vec3 tank = model.find_body("lower tank")->reference_pose();
  double m = 0.0, moment = 0.0;
  Vec2 centre = Vec2::Zero();
  for (const Body& b : model.bodies) {
    const Vec3 pose = b.reference_pose();
    const Vec2 from_tank(pose.x() - tank.x(), pose.y() - tank.y());
    m += b.mass;
    centre += b.mass * from_tank;
    moment += b.inertia + b.mass * from_tank.squaredNorm();
  }
  centre /= m;
  const double k = 200e6, l = 1.5, h = -0.5 - tank.y(), weight = m * 9.81;
  Eigen::Matrix2d mass, stiffness;
  mass << m, m * centre.x(), m * centre.x(), moment;
  stiffness << 2.0 * k, 0.0, 0.0, 2.0 * k * l * l + weight * h - weight * centre.y();
  const Eigen::Vector2d squares = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(stiffness, mass).eigenvalues();
  REQUIRE(found.modes.size() == 2);
  for (int i = 0; i < 2; ++i)
    CHECK(std::abs(2.0 * std::numbers::pi * found.modes[i].natural_frequency() / std::sqrt(squares[i]) - 1.0) < k_digits);
}

TEST_CASE("the paper's transformer, nudged along a mode, follows its eigenvalue") {
  Model model = paper_model(Condition::no_interference);
  model.simulation.velocity.setZero();
  const auto system = compile(model);
  State rest = find_equilibrium(*system, system->initial_state()).state;
  const VibrationModes found = vibration_modes(*system, rest);
  // 12 coordinates move freely in the reference; 7 are held by friction that sticks: 5 vibrate.
  int coordinates = 0;
  for (const VibrationMode& mode : found.modes) coordinates += mode.oscillates() ? 2 : 1;
  CHECK(coordinates == 2 * 5);
  CHECK(found.rigid_motions == 0);
  for (const VibrationMode& mode : found.modes) {
    CAPTURE(mode.natural_frequency());
    CHECK(mode.eigenvalue.real() < 0.0); // every motion is damped
    if (!mode.oscillates()) continue;
    // Small against the feet's depth (0.2 mm), large against the rounding of metres.
    constexpr double k_nudge = 1e-8;
    State nudged = rest;
    for (std::size_t i = 3; i < nudged.q.size(); ++i) {
      nudged.q[i] += k_nudge * mode.shape[i].real();
      nudged.v[i] = k_nudge * (mode.eigenvalue * mode.shape[i]).real();
    }
    SimulationOptions o = options({"dop853", 1e-11, 0.02}); // before the pulse begins
    o.output_step = 0.0;
    const RunResult run = simulate(*system, nudged, o);
    const std::complex<double> factor = std::exp(mode.eigenvalue * 0.02);
    double worst = 0.0;
    for (std::size_t i = 3; i < nudged.q.size(); ++i) {
      const double expected = (factor * mode.shape[i]).real();
      worst = std::max(worst, std::abs((run.final_state.q[i] - rest.q[i]) / k_nudge - expected));
    }
    // Rest is found to 1e-15 m, a ten-millionth of the nudge; what is not linear is of the order of the
    // nudge over the geometry's millimetres.
    CHECK(worst < 1e-4);
  }
}

// A compound pendulum of ω² = m g r/(J + m r²) beside 10 g on a damper of 3e6 N s/m, which creeps back at about −k/c and
// forth at −c/m: λ² + (c/m) λ + k/m = 0, the slow root as (k/m)/fast, which does not cancel. Fourteen decades between
// them: each mode is known to its own rounding.
TEST_CASE("slow modes beside a fast, strongly damped one keep their digits") {
  const VibrationModes found = modes_of(R"(
[simulation]
step = 1e-3
[[body]]
name = "bob"
mass = 1.0
inertia = 0.01
position = [0.0, -0.75]
[[body]]
name = "grain"
mass = 0.01
inertia = 1e-5
position = [3.0, 0.0]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "bob", point = [0.0, 0.75] }
[[element]]
kind = "bushing"
name = "mount"
a = "grain"
b = { body = "ground", at = [3.0, 0.0] }
stiffness = [1e4, 1e6]
damping = [3e6, 3e6]
rotational_stiffness = 1e3
rotational_damping = 1e3
)");
  REQUIRE(found.modes.size() == 7);
  CHECK(found.rigid_motions == 0);
  std::vector<double> expected;
  for (const auto& [mass, c, k] : {std::array{0.01, 3e6, 1e4}, std::array{0.01, 3e6, 1e6}, std::array{1e-5, 1e3, 1e3}}) {
    const double b = 0.5 * c / mass, fast = b + std::sqrt(b * b - k / mass);
    expected.insert(expected.end(), {fast, k / mass / fast});
  }
  expected.push_back(std::sqrt(9.81 * 0.75 / (0.01 + 0.75 * 0.75)));
  std::sort(expected.begin(), expected.end());
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(std::abs(size_of(found.modes[i].eigenvalue) / expected[i] - 1.0) < 1e-12);
  CHECK(std::abs(found.modes[3].damping_ratio()) < 1e-9);
}

// Three masses on guides, each on a damper alone: nothing holds any of them, and each velocity decays with c/m.
TEST_CASE("dampers resist but do not hold") {
  std::string text = "gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n";
  for (const char* name : {"1", "2", "3"})
    text += std::string("[[body]]\nname = \"") + name +
            "\"\nmass = 2.0\ninertia = 1.0\n[[element]]\nkind = \"prismatic\"\nname = \"guide " + name + "\"\na = \"" + name +
            "\"\naxis = [1.0, 0.0]\n[[element]]\nkind = \"spring_damper\"\nname = \"damper " + name + "\"\na = \"" + name +
            "\"\naxis = [1.0, 0.0]\nstiffness = 0.0\ndamping = " + name + "0.0\n";
  const VibrationModes found = modes_of(text);
  CHECK(found.rigid_motions == 3);
  REQUIRE(found.modes.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(std::abs(found.modes[i].eigenvalue + 5.0 * (i + 1)) < 1e-13);
}

// --- large scenes ---------------------------------------------------------------------------------------------------

namespace {

VibrationModes modes_of(const std::string& text, const WantedModes& wanted, ModesAlgebra algebra = ModesAlgebra::by_size) {
  const auto system = compile(parse_model(text, "scene.toml", transformer_catalog()));
  return vibration_modes(*system, find_equilibrium(*system, system->initial_state()).state, wanted, algebra);
}

// Masses that hang on springs of their own, `held` of one kind and `loose` without, beside each other.
std::string apart(int held, int loose) {
  std::string text = "gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n";
  for (int i = 0; i < held + loose; ++i) {
    const std::string name = "m" + std::to_string(i);
    text += "[[body]]\nname = \"" + name + "\"\nmass = 4.0\ninertia = 1.0\nposition = [" + std::to_string(i) + ".0, 0.0]\n";
    if (i < held)
      text += "[[element]]\nkind = \"bushing\"\nname = \"spring " + std::to_string(i) + "\"\na = \"" + name +
              "\"\nb = { body = \"ground\", at = [" + std::to_string(i) +
              ".0, 0.0] }\nstiffness = [400.0, 900.0]\nrotational_stiffness = 1600.0\n";
  }
  return text;
}

} // namespace

// What rounding leaves of the slowest: its square is 2e-6 of the stiffest one's.
TEST_CASE("the slowest modes of a chain of 700 masses, and those near a frequency") {
  const int n = 700;
  const auto system = compile(parse_model(long_chain(n), "scene.toml", transformer_catalog()));
  const State rest = find_equilibrium(*system, system->initial_state()).state;
  const VibrationModes slowest = vibration_modes(*system, rest);
  REQUIRE(slowest.modes.size() == static_cast<std::size_t>(k_usual_modes));
  CHECK_FALSE(slowest.is_all);
  CHECK(slowest.is_counted);
  CHECK(slowest.rigid_motions == 0);
  for (int k = 1; k <= k_usual_modes; ++k) {
    const VibrationMode& mode = slowest.modes[static_cast<std::size_t>(k - 1)];
    CHECK(std::abs(size_of(mode.eigenvalue) / chain_rate(n, k) - 1.0) < k_digits);
    CHECK(mode.residual < k_digits);
    // sin(k π i/(n + 1)): the share of the largest, up to the residual over what parts neighbours, 2/k.
    const std::complex<double> ratio = mode.shape[3 * 100] / mode.shape[3 * 1];
    CHECK(std::abs(ratio - std::sin(100.0 * k * std::numbers::pi / (n + 1)) / std::sin(k * std::numbers::pi / (n + 1))) < 1e-5);
  }
  const double near = chain_rate(n, 300) / (2.0 * std::numbers::pi) + 1e-4;
  const VibrationModes within = vibration_modes(*system, rest, {7, near});
  REQUIRE(within.modes.size() == 7);
  CHECK(within.is_counted);
  for (int i = 0; i < 7; ++i)
    CHECK(std::abs(size_of(within.modes[static_cast<std::size_t>(i)].eigenvalue) / chain_rate(n, 297 + i) - 1.0) < k_digits);
}

// A chain of n rods, L long, hangs from its end: as n grows a heavy rope, ω_k = (j_k/2) √(g/L) with J₀(j_k) = 0. Rods bend at
// their ends alone, which is off by a share of 1/n².
TEST_CASE("a hanging chain's modes go to those of a rope as its rods become short") {
  const double zeros[] = {2.404825557695773, 5.520078110286311, 8.653727912911013};
  double off[2][3];
  for (const int part : {0, 1}) {
    const int n = part == 0 ? 300 : 600;
    std::string text = "[simulation]\nstep = 1e-3\n";
    for (int i = 0; i < n; ++i)
      text += "[[body]]\nname = \"rod " + std::to_string(i) +
              "\"\nmass = 1.0\ninertia = 0.083333333333333333\n[[element]]\nkind = \"revolute\"\nname = \"pin " + std::to_string(i) +
              "\"\na = { body = \"rod " + std::to_string(i) + "\", point = [-0.5, 0.0] }\nb = " +
              (i > 0 ? "{ body = \"rod " + std::to_string(i - 1) + "\", point = [0.5, 0.0] }\nangle = 0.0\n"
                     : std::string("\"ground\"\nangle = -1.5707963267948966\n"));
    const VibrationModes found = modes_of(text, {3, std::nullopt}, ModesAlgebra::sparse);
    REQUIRE(found.modes.size() == 3);
    for (int k = 0; k < 3; ++k)
      off[part][k] = size_of(found.modes[static_cast<std::size_t>(k)].eigenvalue) / (0.5 * zeros[k] * std::sqrt(9.81 / n)) - 1.0;
  }
  for (int k = 0; k < 3; ++k) {
    CHECK(std::abs(off[1][k]) < 2e-5);
    CHECK(off[0][k] / off[1][k] == doctest::Approx(4.0).epsilon(0.01)); // terms beyond are as 1/n⁴ and smaller
  }
}

// Damped, constrained, with friction that sticks, with what is free.
TEST_CASE("sparse algebra finds the modes that dense algebra finds") {
  for (const char* name :
       {"paper/no_interference", "paper/interference", "machines/tank_with_lid", "machines/watt_linkage", "benchmarks/grid_5"}) {
    CAPTURE(std::string(name));
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/" + name + ".toml", transformer_catalog());
    const auto system = compile(model);
    State rest = find_equilibrium(*system, system->initial_state()).state;
    std::fill(rest.v.begin(), rest.v.end(), 0.0);
    const VibrationModes all = vibration_modes(*system, rest, {}, ModesAlgebra::dense);
    const double middle = all.modes[all.modes.size() / 2].natural_frequency();
    for (const auto& near : {std::optional<double>(), std::optional<double>(middle)}) {
      const WantedModes wanted{std::min(4, static_cast<int>(all.modes.size())), near};
      const VibrationModes dense = vibration_modes(*system, rest, wanted, ModesAlgebra::dense);
      const VibrationModes sparse = vibration_modes(*system, rest, wanted, ModesAlgebra::sparse);
      CHECK(sparse.rigid_motions == all.rigid_motions);
      REQUIRE(sparse.modes.size() == dense.modes.size());
      for (std::size_t i = 0; i < dense.modes.size(); ++i) { // residuals are below 1e-9 of the eigenvalue's square
        CHECK(size_of(sparse.modes[i].eigenvalue - dense.modes[i].eigenvalue) < 1e-7 * size_of(dense.modes[i].eigenvalue));
        CHECK(sparse.modes[i].residual < 1e-8);
      }
    }
  }
}

// As many of one frequency as there are masses, more than the space begins with; and what nothing holds beside them.
TEST_CASE("modes of one frequency are found as often as they are there") {
  const VibrationModes found = modes_of(apart(40, 3), {50, std::nullopt}, ModesAlgebra::sparse);
  CHECK(found.rigid_motions == 9);
  REQUIRE(found.modes.size() == 50);
  CHECK(found.is_counted);
  for (int i = 0; i < 50; ++i) // √(400/4) = 10, √(900/4) = 15
    CHECK(size_of(found.modes[static_cast<std::size_t>(i)].eigenvalue) == doctest::Approx(i < 40 ? 10.0 : 15.0).epsilon(1e-12));
}

TEST_CASE("a large scene without vibrations has none, and says what moves freely") {
  const auto system = compile(parse_model(apart(0, 600), "scene.toml", transformer_catalog()));
  const VibrationModes found = vibration_modes(*system, system->initial_state());
  CHECK(found.modes.empty());
  CHECK(found.rigid_motions == 1800);
  CHECK(found.is_all);
}

// Friction whose bound is zero holds nothing: what it acts along swings as without it.
TEST_CASE("friction with a bound of zero does not hold a motion") {
  const auto slowest = [](const std::string& text) {
    const VibrationModes found = modes_of(text);
    REQUIRE(!found.modes.empty());
    return 2.0 * std::numbers::pi * found.modes.front().natural_frequency();
  };
  const std::string still = "gravity = [0.0, 0.0]\n";
  // A buffer with one curve is a spring of 400 N/m at its depth, on 2 kg.
  const std::string buffer = "gravity = [-20.0, 0.0]\n[[body]]\nname = \"A\"\nmass = 2.0\ninertia = 1.0\nposition = [1.0, 0.0]\n"
                             "[[element]]\nkind = \"prismatic\"\nname = \"g\"\na = \"A\"\nb = { body = \"ground\", at = [1.0, 0.0] }\n"
                             "[[element]]\nkind = \"buffer\"\nname = \"s\"\na = \"A\"\naxis = [1.0, 0.0]\ngap = -0.15\n"
                             "loading = [[0.0, 0.0], [0.1, 20.0], [0.2, 60.0]]\n";
  CHECK(std::abs(slowest(buffer) / std::sqrt(400.0 / 2.0) - 1.0) < k_digits);
  CHECK(modes_of(buffer + "unloading = [[0.0, 0.0], [0.1, 10.0], [0.2, 30.0]]\n").modes.empty()); // sticks between two curves
  // A box of 1000 kg on level feet, held along x by 1000 N/m; the feet bear nothing along x.
  const auto box = [](const std::string& floor) {
    return "[[body]]\nname = \"box\"\nmass = 1000.0\ninertia = 500.0\nposition = [0.0, 0.5]\n"
           "outline = [[-0.8, -0.5], [0.8, -0.5], [0.8, 0.5], [-0.8, 0.5]]\n"
           "[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = \"box\"\nb = { body = \"ground\", at = [-1.0, 0.5] }\n"
           "axis = [1.0, 0.0]\nstiffness = 1000.0\n" +
           floor;
  };
  const auto feet = [&](double friction) {
    std::string text;
    for (const char* x : {"-0.8", "0.8"})
      text += std::string("[[element]]\nkind = \"unilateral_contact\"\nname = \"foot ") + x + "\"\na = { body = \"box\", at = [" + x +
              ", 0.0] }\nstiffness = 5e7\n";
    return box(text +
               "[[element]]\nkind = \"coulomb_stick\"\nname = \"floor\"\ncontacts = [\"foot -0.8\", \"foot 0.8\"]\n"
               "static_friction = " +
               exact(friction) + "\n");
  };
  CHECK(std::abs(slowest(feet(0.0)) - 1.0) < k_digits);
  CHECK(slowest(feet(0.3)) > 100.0); // the feet alone, of 5e7 N/m each
  const std::string face = "[[element]]\nkind = \"polygon_contact\"\nname = \"floor\"\na = \"box\"\nstiffness = 5e7\n";
  const VibrationModes none = modes_of(box(face)), zero = modes_of(box(face + "static_friction = 0.0\n"));
  REQUIRE(none.modes.size() == 3);
  REQUIRE(zero.modes.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(std::abs(zero.modes[i].natural_frequency() / none.modes[i].natural_frequency() - 1.0) < k_digits);
  // A pendulum whose bearing, at 1e6 N/m, gives little: √(m g l/(J + m l²)) to the ratio of its stiffnesses, m g/l to 1e6 N/m.
  const auto pendulum = [](const char* friction) {
    return std::string("[[body]]\nname = \"A\"\nmass = 2.0\ninertia = 3.0\nposition = [0.0, -1.0]\n"
                       "[[element]]\nkind = \"bearing\"\nname = \"b\"\na = { body = \"A\", at = [0.0, 0.0] }\nstiffness = 1e6\n"
                       "radius = 0.1\nstatic_friction = ") +
           friction + "\n";
  };
  CHECK(std::abs(slowest(pendulum("0.0")) / std::sqrt(2.0 * 9.81 / 5.0) - 1.0) < 1e-4);
  CHECK(slowest(pendulum("0.2")) > 100.0);
  // A gear without losses against a shaft that is held: 200 N m/rad on 3 kg m².
  const auto gear = [&still](const char* efficiency) {
    return still +
           "[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 3.0\n[[element]]\nkind = \"revolute\"\nname = \"p\"\na = \"a\"\n"
           "[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 3.0\nposition = [1.0, 0.0]\n"
           "[[element]]\nkind = \"weld\"\nname = \"held\"\na = \"b\"\n"
           "[[element]]\nkind = \"lossy_gear\"\nname = \"s\"\na = \"a\"\nb = \"b\"\nratio = 2.0\nstiffness = 200.0\nefficiency = " +
           efficiency + "\n";
  };
  CHECK(std::abs(slowest(gear("1.0")) / std::sqrt(200.0 / 3.0) - 1.0) < k_digits);
}

TEST_CASE("what the modes leave out is said: inner states that are held, and kinks at the rest") {
  const auto remarks = [](const std::string& more) {
    const auto system =
        compile(parse_model("gravity = [0.0, 0.0]\n" + std::string(k_guided_mass) + more, "scene.toml", transformer_catalog()));
    const State rest = find_equilibrium(*system, system->initial_state()).state;
    std::string text;
    for (const std::string& remark : remarks_on_modes(*system, rest)) text += remark + "\n";
    return text;
  };
  CHECK(remarks("").empty());
  CHECK(remarks("[[state]]\nname = \"wear\"\nunit = \"m\"\nrate = \"mass.vy\"\n[[element]]\nkind = \"force\"\nname = \"servo\"\n"
                "a = \"mass\"\ncoordinate = \"y\"\nformula = \"'-100 N/m' * wear\"\n")
            .find("'wear'") != std::string::npos);
  const auto table = [&](const char* points) {
    return remarks(std::string("[[element]]\nkind = \"spring_damper\"\nname = \"bent\"\na = \"mass\"\naxis = [0.0, 1.0]\nforce_table = ") +
                   points + "\n");
  };
  CHECK(table("[[-0.1, -5.0], [0.0, 0.0], [0.1, 20.0]]").find("kink of 'bent'") != std::string::npos); // 50 N/m below, 200 N/m above
  CHECK(table("[[-0.1, -20.0], [0.0, 0.0], [0.1, 20.0]]").empty());                                    // one slope
  CHECK(table("[[-0.1, -5.0], [-0.01, 0.0], [0.1, 20.0]]").empty());                                   // 10 mm away
}

// A mass m on a spring k beside a spring k₁ in series with a damper c: with the force f of the latter, f' = k₁ v − (k₁/c) f, so that
// (m λ² + k) (λ + k₁/c) + k₁ λ = 0.
TEST_CASE("a spring and damper in series stiffens and damps") {
  const auto creep = [](const std::string& name, double stiffness, double damping) {
    return "[[element]]\nkind = \"maxwell\"\nname = \"" + name + "\"\na = \"mass\"\naxis = [0.0, 1.0]\nstiffness = " + exact(stiffness) +
           "\ndamping = " + exact(damping) + "\n";
  };
  const auto left = [](std::complex<double> at, double k, double k1, double c) {
    return std::abs((4.0 * at * at + k) * (at + k1 / c) + k1 * at) / std::abs(4.0 * at * at * at);
  };
  const std::string still = "gravity = [0.0, 0.0]\n";
  const VibrationModes one = modes_of(still + k_guided_mass + creep("creep", 300.0, 30.0));
  REQUIRE(one.modes.size() == 2); // one that oscillates, one that decays
  for (const VibrationMode& mode : one.modes) CHECK(left(mode.eigenvalue, 400.0, 300.0, 30.0) < 1e-12);
  CHECK(std::abs(one.modes[0].eigenvalue - one.modes[1].eigenvalue) > 1.0);
  for (const VibrationMode& mode : one.modes) CHECK(mode.residual < 1e-12);
  // Two halves side by side are one; that they relax against each other moves nothing.
  const VibrationModes two = modes_of(still + k_guided_mass + creep("one", 150.0, 15.0) + creep("other", 150.0, 15.0));
  REQUIRE(two.modes.size() == 2);
  for (int i = 0; i < 2; ++i) CHECK(std::abs(two.modes[i].eigenvalue - one.modes[i].eigenvalue) < 1e-9 * std::abs(one.modes[i].eigenvalue));
  // Without the spring, (m λ (λ + k₁/c) + k₁) λ = 0: it drifts where it was left.
  const std::string alone = std::string(k_guided_mass).substr(0, std::string(k_guided_mass).find("[[element]]\nkind = \"spring_damper\""));
  const VibrationModes loose = modes_of(still + alone + creep("creep", 300.0, 30.0));
  CHECK(loose.rigid_motions == 1);
  for (const VibrationMode& mode : loose.modes) CHECK(left(mode.eigenvalue, 0.0, 300.0, 30.0) < 1e-12);
  REQUIRE(loose.modes.size() == 1); // the conjugate pair of 4 λ² + 40 λ + 300 = 0
}
