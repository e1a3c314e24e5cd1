// The linearised equations of motion against central differences of Dynamics::rates.
#include "mbd/dynamics/linearization.h"
#include "tests/elements/step_lap/step_lap_scene.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Central differences over h: truncation h² f'''/6 and rounding 1e-16 f/h meet near h = 1e-5 of what f varies
// over; two steps and Richardson's extrapolation leave about 1e-9 of the largest entry of the same kind.
constexpr double k_step = 2e-5;

// Largest deviation of ∂a/∂q and ∂a/∂v from differences, each against the largest entry of its matrix.
double deviation(Dynamics& dynamics, const State& state, double pose_step, double rate_step) {
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension()), ahead(y), behind(y);
  dynamics.pack(state, y.data());
  Linearization linear;
  linear.evaluate(dynamics, state.t, y.data());
  MatX exact[2];
  linear.acceleration_by_state(exact[0], exact[1]);
  const int n = dynamics.coordinate_count();
  double worst = 0.0;
  for (int kind = 0; kind < 2; ++kind) {
    MatX difference = MatX::Zero(n, n);
    const auto slope = [&](int column, double h) {
      std::vector<double> moved = y;
      moved[kind * n + column] += h;
      dynamics.rates(state.t, moved.data(), ahead.data());
      moved[kind * n + column] -= 2.0 * h;
      dynamics.rates(state.t, moved.data(), behind.data());
      return VecX((VecX::Map(ahead.data() + n, n) - VecX::Map(behind.data() + n, n)) / (2.0 * h));
    };
    const double h = kind == 0 ? pose_step : rate_step;
    for (int c = 0; c < n; ++c) difference.col(c) = (4.0 * slope(c, h) - slope(c, 2.0 * h)) / 3.0;
    const double size = std::max(1.0, difference.cwiseAbs().maxCoeff());
    worst = std::max(worst, (exact[kind] - difference).cwiseAbs().maxCoeff() / size);
  }
  return worst;
}

const char* k_joints = R"(
[simulation]
step = 1e-3
[[signal]]
name = "wave"
kind = "harmonics"
amplitudes = [0.5]
frequencies = [0.8]
[[body]]
name = "carriage"
mass = 3.0
inertia = 0.4
position = [0.0, 0.2]
angle = 0.3
[[body]]
name = "arm"
mass = 2.0
inertia = 0.3
position = [0.6, 0.4]
velocity = [0.3, -0.2]
angular_velocity = 0.7
[[body]]
name = "tip"
mass = 1.0
inertia = 0.1
position = [1.3, -0.1]
velocity = [-0.5, 0.4]
angular_velocity = -1.1
[[body]]
name = "tail"
mass = 0.7
inertia = 0.05
position = [1.7, 0.3]
[[body]]
name = "slider"
mass = 1.4
inertia = 0.2
position = [0.4, 1.2]
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "carriage"
coordinate = "x"
signal = "wave"
as = "velocity"
[[element]]
kind = "revolute"
name = "shoulder"
a = { body = "arm", at = [0.1, 0.3] }
b = { body = "carriage", at = [0.1, 0.3] }
[[element]]
kind = "distance"
name = "rod"
a = { body = "tip", at = [1.2, 0.1] }
b = { body = "arm", at = [0.8, 0.5] }
[[element]]
kind = "weld"
name = "tail weld"
a = "tail"
b = "tip"
[[element]]
kind = "prismatic"
name = "guide"
a = "slider"
b = { body = "arm", at = [0.5, 0.8] }
axis = [0.6, 0.8]
[[element]]
kind = "bushing"
name = "mount"
a = { body = "carriage", at = [0.0, 0.0] }
b = "ground"
stiffness = [500.0, 900.0]
damping = [20.0, 30.0]
rotational_stiffness = 60.0
rotational_damping = 2.0
[[element]]
kind = "spring_damper"
name = "tie"
a = { body = "tail", at = [1.8, 0.4] }
b = { body = "carriage", at = [-0.2, 0.3] }
stiffness = 300.0
damping = 12.0
[[element]]
kind = "spring_damper"
name = "return"
a = "slider"
b = { body = "tip", at = [1.3, 0.2] }
stiffness = 200.0
damping = 5.0
)";

} // namespace

TEST_CASE("linearisation: joints, welded bodies off their common centre, a driven body") {
  const auto system = compile(scene(k_joints));
  SimulationOptions options;
  options.integrator = "dop853";
  options.settings.tolerance = 1e-10;
  options.end = 1.0;
  Simulation simulation(*system, system->initial_state(), options);
  Dynamics dynamics(*system);
  dynamics.set_left_limit_time(2.0);
  int looks = 0;
  for (double next = 0.0; simulation.advance();) {
    const State state = simulation.current_state();
    if (state.t < next) continue;
    next = state.t + 0.2;
    CAPTURE(state.t);
    CHECK(deviation(dynamics, state, k_step, k_step) < 3e-8);
    ++looks;
  }
  CHECK(looks >= 4);
}

// A spring with a damper couples a chain of two rods, in joint coordinates, to a body in its own.
TEST_CASE("linearisation: a mechanism in joint coordinates beside a body in absolute ones") {
  const auto system = compile(scene(R"(
[simulation]
step = 1e-3
[[body]]
name = "upper"
mass = 2.0
inertia = 0.3
position = [0.3, -0.4]
[[body]]
name = "lower"
mass = 1.0
inertia = 0.1
position = [0.9, -0.9]
[[body]]
name = "ball"
mass = 0.7
inertia = 0.2
position = [1.6, -0.2]
[[element]]
kind = "revolute"
name = "top"
a = { body = "upper", at = [0.0, 0.0] }
b = "ground"
[[element]]
kind = "revolute"
name = "middle"
a = { body = "lower", at = [0.6, -0.8] }
b = { body = "upper", at = [0.6, -0.8] }
[[element]]
kind = "spring_damper"
name = "strut"
a = { body = "lower", at = [1.2, -1.0] }
b = { body = "ball", at = [1.5, -0.3] }
stiffness = 200.0
damping = 15.0
[[element]]
kind = "bushing"
name = "mount"
a = "ball"
b = "ground"
stiffness = [300.0, 500.0]
damping = [4.0, 6.0]
rotational_stiffness = 40.0
rotational_damping = 2.0
)"));
  Dynamics dynamics(*system);
  dynamics.use_coordinates(Coordinates::joint);
  dynamics.set_left_limit_time(1.0);
  const State state = system->initial_state();
  dynamics.set_state(state);
  REQUIRE(dynamics.layout().has_mechanisms());
  REQUIRE(dynamics.layout().absolute_count == 1);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension()));
  dynamics.pack(state, y.data());
  const int n = dynamics.coordinate_count();
  for (int i = 0; i < n; ++i) y[n + i] = 0.4 - 0.3 * i; // nothing at rest
  State moving = state;
  dynamics.unpack(0.0, y.data(), moving);
  CHECK(deviation(dynamics, moving, k_step, k_step) < 3e-8);
}

// Nothing but weight and what pins bear: columns of angles that no spring asks about.
TEST_CASE("linearisation: pendulums that weight alone moves") {
  for (int count = 1; count <= 4; ++count) {
    CAPTURE(count);
    std::string text = "gravity = [0.0, -9.0]\n[simulation]\nstep = 1e-3\n";
    for (int i = 0; i < count; ++i) {
      const std::string name = "rod " + std::to_string(i), above = i > 0 ? "rod " + std::to_string(i - 1) : "ground";
      const std::string place = "[" + std::to_string(0.5 * i) + ", 0.0]";
      text += "[[body]]\nname = '" + name + "'\nmass = " + std::to_string(1.0 + 0.5 * i) + "\ninertia = 0.1\nposition = [" +
              std::to_string(0.5 * i + 0.3) + ", 0.1]\n[[element]]\nkind = 'revolute'\nname = 'pin of " + name + "'\na = { body = '" +
              name + "', at = " + place + " }\nb = { body = '" + above + "', at = " + place + " }\n";
    }
    const auto system = compile(scene(text));
    Dynamics dynamics(*system);
    dynamics.use_coordinates(Coordinates::joint);
    dynamics.set_left_limit_time(1.0);
    const State state = system->initial_state();
    dynamics.set_state(state);
    REQUIRE(dynamics.coordinate_count() == count);
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension()));
    dynamics.pack(state, y.data());
    for (int i = 0; i < count; ++i) {
      y[i] += 0.7 - 0.5 * i;
      y[count + i] = 0.9 - 0.6 * i;
    }
    State moving = state;
    dynamics.unpack(0.0, y.data(), moving);
    CHECK(deviation(dynamics, moving, k_step, k_step) < 3e-8);
    if (count > 1) continue;
    // θ̈ = −m g l cos φ/(J + m l²), φ the angle of the way from the pin to the centre against x.
    Linearization linear;
    linear.evaluate(dynamics, 0.0, y.data());
    MatX by_pose, by_rate;
    linear.acceleration_by_state(by_pose, by_rate);
    const double angle = 0.7 + std::atan2(0.1, 0.3);
    CHECK(by_pose(0, 0) == doctest::Approx(9.0 * std::sqrt(0.1) * std::sin(angle) / (0.1 + 0.1)).epsilon(1e-13));
    CHECK(by_rate(0, 0) == 0.0);
  }
}

// Bodies in free flight whose sheets overlap in part, alone and with others welded to them: where they are tells how much of them rubs and
// about which arms, and no spring is there beside which that would be small.
TEST_CASE("linearisation: a joint that slides, and nothing else") {
  using namespace step_lap_scene;
  const std::string alone = header("end = 0.01", 0.01) + body("limb", 10.0, 0.1, {0.03, 0.02}, {0.5, 0.2}, 0.3) +
                            body("yoke", 20.0, 0.3, {-0.02, 0.01}, {-0.1, 0.1}, -0.4) + joint("limb", "yoke") +
                            interface(rectangle(-1.0, -1.0, 0.05, 0.04), rectangle(-0.1, -0.05, 0.12, 0.06), 1e6, 0.4);
  const auto weld = [](const std::string& a, const std::string& b) {
    return "[[element]]\nkind = \"weld\"\nname = \"" + a + " on " + b + "\"\na = \"" + a + "\"\nb = \"" + b + "\"\n";
  };
  const std::string riding = alone + body("weight", 6.0, 0.4, {0.4, 0.3}, {0.41, 0.32}, 0.3) + weld("weight", "limb") +
                             body("ballast", 9.0, 0.5, {-0.5, 0.2}, {-0.02, 0.3}, -0.4) + weld("ballast", "yoke");
  for (const std::string& text : {alone, riding}) {
    const auto system = compile(scene(text));
    REQUIRE(system->frictions.size() == 1);
    State state = system->initial_state();
    state.friction[0].phase = FrictionPhase::slip;
    Dynamics dynamics(*system);
    dynamics.set_left_limit_time(1.0);
    dynamics.set_state(state);
    REQUIRE(dynamics.layout().sliding.size() == 1);
    CHECK(deviation(dynamics, state, k_step, k_step) < 1e-5); // the slip law's own differences
  }
}

// Its friction hangs on how deep it is pressed: by 2 kN/m against the 6 kN/m of its middle curve.
TEST_CASE("linearisation: a buffer that is pressed in, across the axes") {
  const auto system = compile(scene(R"(
[simulation]
step = 1e-3
[[body]]
name = "wagon"
mass = 3.0
inertia = 0.4
position = [0.3, 0.5]
velocity = [-0.4, -0.5]
angular_velocity = 0.2
[[body]]
name = "other"
mass = 2.0
inertia = 0.3
position = [-0.4, -0.3]
angle = 0.2
[[element]]
kind = "buffer"
name = "buffer"
a = { body = "wagon", at = [0.2, 0.2] }
b = { body = "other", at = [0.1, 0.0] }
axis = [0.6, 0.8]
gap = -0.02
loading = [[0.0, 0.0], [0.1, 800.0]]
unloading = [[0.0, 0.0], [0.1, 400.0]]
)"));
  REQUIRE(system->frictions.size() == 1);
  SimulationOptions options;
  options.integrator = "dop853";
  options.end = 1e-3;
  Simulation simulation(*system, system->initial_state(), options);
  REQUIRE(simulation.advance());
  State state = simulation.current_state(); // pressed
  for (const int sign : {-1, 1}) {
    state.friction[0].phase = FrictionPhase::slip;
    state.friction[0].sign = static_cast<std::int8_t>(sign);
    Dynamics dynamics(*system);
    dynamics.set_left_limit_time(1.0);
    dynamics.set_state(state);
    REQUIRE(dynamics.layout().sliding.size() == 1);
    CHECK(deviation(dynamics, state, k_step, k_step) < 1e-6); // the slip law's own differences
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y);
    dynamics.pack(state, y.data());
    dynamics.rates(state.t, y.data(), dy.data());
    CHECK(-sign * dynamics.snapshot(dy.data()).friction_force[0] > 30.0); // of 40 N at its depth of 20 mm
  }
}

// Stiffness over mass is 1e5 1/s² and more here, and friction sits on springs of 1.6e9 N/m.
TEST_CASE("linearisation: the paper's transformer sticking, sliding, with feet lifted and blocks pressed") {
  for (const char* name : {"paper/no_interference", "paper/weak_clamping"}) {
    CAPTURE(std::string(name));
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/" + name + ".toml", transformer_catalog());
    const auto system = compile(model);
    SimulationOptions options = options_of(model);
    options.integrator = "tsit5";
    options.settings.tolerance = 1e-7;
    options.output_step = 0.0;
    options.settings.max_step = 0.01;
    options.end = 0.3;
    Simulation simulation(*system, system->initial_state(), options);
    Dynamics dynamics(*system);
    dynamics.set_left_limit_time(1.0);
    int phases[4] = {}, open = 0, looks = 0;
    for (double next = 0.0; simulation.advance();) {
      const State state = simulation.current_state();
      bool is_onset = false;
      for (std::size_t f = 0; f < state.friction.size(); ++f)
        if (system->frictions[f].friction->dimension() == 3 && state.friction[f].is_onset) is_onset = true;
      if (state.t < next || is_onset) continue; // a starting joint's law bends within 1e-7 s
      next = state.t + 0.01;
      for (const FrictionState& f : state.friction) ++phases[static_cast<int>(f.phase)];
      for (const UnitMode mode : state.mode) open += mode == k_contact_open ? 1 : 0;
      CAPTURE(state.t);
      CHECK(deviation(dynamics, state, 1e-6, 1e-6) < 1e-6);
      ++looks;
    }
    CHECK(looks >= 15);
    CHECK(phases[static_cast<int>(FrictionPhase::stick)] > 0);
    CHECK(phases[static_cast<int>(FrictionPhase::slip)] > 0);
    CHECK(open > 0);
  }
}

namespace {

// An elastic joint between two bodies, to each of which another one is welded: both ride off their clusters' centres.
std::string riding_joint() {
  using namespace step_lap_scene;
  const auto weld = [](const std::string& a, const std::string& b) {
    return "[[element]]\nkind = \"weld\"\nname = \"" + a + " on " + b + "\"\na = \"" + a + "\"\nb = \"" + b + "\"\n";
  };
  return header("end = 0.01\nintegrator = \"dop853\"\ntolerance = 1e-9", 0.01) + body("limb", 10.0, 1.0, {0.0, 0.0}, {0.5, 0.2}, 0.3) +
         body("weight", 6.0, 0.4, {0.4, 0.3}, {0.41, 0.32}, 0.3) + body("yoke", 20.0, 3.0, {0.0, 0.0}) +
         body("ballast", 9.0, 0.5, {-0.5, 0.2}) + weld("weight", "limb") + weld("ballast", "yoke") +
         joint("limb", "yoke", "tangential_stiffness = 1e6") +
         interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2);
}

/// ∂(forces)/∂z, ∂ż/∂q, ∂ż/∂v and ∂ż/∂z of all inner states z.
struct InnerSlopes {
  MatX force, by_pose, by_velocity, by_inner;
  InnerSlopes(int coordinates, int inner)
      : force(MatX::Zero(coordinates, inner)), by_pose(MatX::Zero(inner, coordinates)), by_velocity(MatX::Zero(inner, coordinates)),
        by_inner(MatX::Zero(inner, inner)) {}
};

// Those of blocks, and those that stand by themselves.
InnerSlopes gathered(const Linearization& linear, int coordinates) {
  InnerSlopes all(coordinates, linear.inner_count());
  for (const Linearization::InnerBlock& block : linear.inner()) {
    for (int i = 0; i < block.count; ++i) {
      const int z = block.first + i;
      for (int k = 0; k < 6; ++k) {
        const int at = 3 * block.cluster[k / 3] + k % 3;
        all.force(at, z) += block.force(k, i);
        all.by_pose(z, at) += block.by_pose(i, k);
        all.by_velocity(z, at) += block.by_velocity(i, k);
      }
      for (int c = 0; c < block.count; ++c) all.by_inner(z, block.first + c) += block.by_inner(i, c);
    }
  }
  const Linearization::StateParts& states = linear.states();
  for (const auto& e : states.by_pose) all.by_pose(e.row(), e.col()) += e.value();
  for (const auto& e : states.by_velocity) all.by_velocity(e.row(), e.col()) += e.value();
  for (const auto& e : states.by_state) all.by_inner(e.row(), e.col()) += e.value();
  for (const auto& e : states.forces) all.force(e.row(), e.col()) += e.value();
  return all;
}

// Of what inner states do and what changes them, the largest deviation from central differences, each against the largest entry of its
// kind. Strains are some 1e-4 m, a direction of slip is a vector of 1e-3: steps of 1e-8 leave 1e-8 of truncation and rounding of
// places, 1e-16 m over 1e-8 m.
double inner_deviation(Dynamics& dynamics, const State& state) {
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension()), ahead(y), behind(y);
  dynamics.pack(state, y.data());
  Linearization linear;
  linear.evaluate(dynamics, state.t, y.data());
  const int n = dynamics.coordinate_count(), inner = dynamics.inner_count();
  const InnerSlopes found = gathered(linear, n);
  InnerSlopes expected(n, inner);
  const auto slope = [&](int column, double h) {
    std::vector<double> moved = y;
    moved[column] += h;
    dynamics.rates(state.t, moved.data(), ahead.data());
    moved[column] -= 2.0 * h;
    dynamics.rates(state.t, moved.data(), behind.data());
    return VecX((VecX::Map(ahead.data(), dynamics.dimension()) - VecX::Map(behind.data(), dynamics.dimension())) / (2.0 * h));
  };
  for (int k = 0; k < n; ++k) {
    expected.by_pose.col(k) = slope(k, 1e-8).segment(2 * n, inner);
    expected.by_velocity.col(k) = slope(n + k, 1e-6).segment(2 * n, inner);
  }
  for (int c = 0; c < inner; ++c) {
    const VecX by_state = slope(2 * n + c, 1e-8);
    expected.by_inner.col(c) = by_state.segment(2 * n, inner);
    for (int k = 0; k < n; ++k) expected.force(k, c) = by_state[n + k] / linear.inverse_mass()[k];
  }
  const auto off = [](const MatX& exact, const MatX& difference) {
    return (exact - difference).cwiseAbs().maxCoeff() / std::max(1.0, difference.cwiseAbs().maxCoeff());
  };
  return std::max({off(found.force, expected.force), off(found.by_pose, expected.by_pose), off(found.by_velocity, expected.by_velocity),
                   off(found.by_inner, expected.by_inner)});
}

} // namespace

TEST_CASE("linearisation: inner states of a joint between bodies that ride on others") {
  const auto system = compile(scene(riding_joint()));
  SimulationOptions options;
  options.integrator = "dop853";
  options.settings.tolerance = 1e-9;
  options.end = 0.01;
  Simulation simulation(*system, system->initial_state(), options);
  Dynamics dynamics(*system);
  dynamics.set_left_limit_time(1.0);
  int looks = 0, yields = 0;
  for (double next = 0.0; simulation.advance();) {
    const State state = simulation.current_state();
    if (state.t < next) continue;
    next = state.t + 0.002;
    CAPTURE(state.t);
    CHECK(inner_deviation(dynamics, state) < 1e-5); // the flow's own derivatives are central differences too
    ++looks;
    yields += std::any_of(state.inner.begin(), state.inner.end(), [](double p) { return p != 0.0; }) ? 1 : 0;
  }
  CHECK(looks >= 3);
  CHECK(yields >= 1); // it has slid
}

TEST_CASE("linearisation: inner states of a joint that slides at a corner of its limit surface") {
  // Two overlaps 12 mm wide and 2.2 m apart: the direction of slip is a state, which relaxes at 1e7 1/s.
  using namespace step_lap_scene;
  const std::string text =
      header("end = 0.0175\nintegrator = \"rodas5p\"\ntolerance = 1e-8", 0.01) + body("limb", 1000.0, 700.0, {0.5, 0.0}) +
      joint("limb", "ground", "tangential_stiffness = 1e7") +
      interface(rectangle(0.0, 1.0, 0.3, 1.2), rectangle(0.288, 1.0, 0.6, 1.2), 1e5, 0.25, "count = 400", "top") +
      interface(rectangle(0.0, -1.2, 0.3, -1.0), rectangle(0.292, -1.2, 0.6, -1.0), 1e5, 0.25, "count = 600", "bottom") +
      "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"limb\"\nforce = [60e3, 0.0]\n";
  const auto system = compile(scene(text));
  SimulationOptions options;
  options.integrator = "rodas5p";
  options.settings.tolerance = 1e-8;
  options.end = 0.0175;
  Simulation simulation(*system, system->initial_state(), options);
  Dynamics dynamics(*system);
  dynamics.set_left_limit_time(1.0);
  int looks = 0;
  for (double next = 0.0145; simulation.advance();) {
    const State state = simulation.current_state();
    if (state.t < next) continue;
    next = state.t + 0.0005;
    CAPTURE(state.t);
    // Most are within 1e-4; where edges that lay along each other cross within 1e-7 m, differences as long as that see two slopes of the
    // overlap. Differences of what the wrench tells, 1e-5 of the strain long, are wrong by 1: the corner is 5e-6.
    CHECK(inner_deviation(dynamics, state) < 1e-2);
    ++looks;
  }
  CHECK(looks >= 4);
}
