// Mechanisms in joint coordinates (mbd/dynamics/mechanism.h) against the same bodies in absolute ones: two ways to the
// same accelerations, reactions and motions, which share the forces of elements and nothing else of the way to
// accelerations.
#include "mbd/dynamics/linearization.h"
#include "tests/physics/descriptions.h"
#include "tests/physics/model_text.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A free member with an arm, a rod, a welded tail, a loop of two pins, a guide, springs, a motor, friction in a pin.
std::string everything() {
  return "gravity = [1.0, -9.0]\n[simulation]\nstep = 1e-3\n" +
         body("post", "mass = 3; inertia = 0.4; position = [0.2, 0.5]; angle = 0.3; angular_velocity = 0.4") +
         body("arm", "mass = 2; inertia = 0.3; position = [0.9, 0.8]; velocity = [0.3, -0.2]; angular_velocity = 0.7") +
         body("tip", "mass = 1; inertia = 0.1; position = [1.6, 0.3]; velocity = [-0.5, 0.4]; angular_velocity = -1.1") +
         body("tail", "mass = 0.7; inertia = 0.05; position = [2.0, 0.7]") +
         body("strut", "mass = 0.9; inertia = 0.08; position = [1.2, -0.1]; angular_velocity = 0.5") +
         body("cart", "mass = 1.4; inertia = 0.2; position = [0.4, 1.5]; velocity = [0.2, 0.1]") +
         body("bob", "mass = 0.6; inertia = 0.02; position = [2.2, -0.2]; velocity = [0.1, -0.3]; angular_velocity = 2.0") +
         body("kite", "mass = 1.1; inertia = 0.15; position = [3.0, 2.0]; velocity = [0.4, 0.2]; angular_velocity = 0.6") +
         body("string", "mass = 0.5; inertia = 0.05; position = [3.4, 1.7]") +
         element("revolute", "foot", "a = { body = 'post', at = [0.0, 0.1] }") +
         element("revolute", "shoulder", "a = { body = 'arm', at = [0.5, 0.9] }; b = { body = 'post', at = [0.5, 0.9] }") +
         element("revolute", "wrist", "a = { body = 'arm', at = [1.3, 0.6] }; b = { body = 'tip', at = [1.3, 0.6] }") +
         element("weld", "tail weld", "a = 'tail'; b = 'tip'") +
         element("revolute", "strut top", "a = { body = 'strut', at = [1.7, 0.1] }; b = { body = 'tail', at = [1.7, 0.1] }") +
         element("revolute", "strut foot", "a = { body = 'strut', at = [0.8, -0.3] }; b = { body = 'ground', at = [0.8, -0.3] }") +
         element("prismatic", "guide", "a = 'cart'; b = { body = 'post', at = [0.4, 1.2] }; axis = [0.6, 0.8]") +
         element("distance", "rod", "a = { body = 'bob', at = [2.3, -0.1] }; b = { body = 'tail', at = [2.2, 0.6] }") +
         element("revolute", "kite pin", "a = { body = 'string', at = [3.2, 1.8] }; b = { body = 'kite', at = [3.2, 1.8] }") +
         element("spring_damper", "tie",
                 "a = { body = 'kite', at = [2.8, 1.9] }; b = { body = 'tip', at = [1.8, 0.2] }; stiffness = 90; "
                 "damping = 4") +
         element("spring_damper", "return", "a = 'cart'; b = { body = 'bob', at = [2.1, -0.2] }; stiffness = 40; damping = 2") +
         element("bushing", "mount",
                 "a = { body = 'post', at = [0.1, 0.4] }; b = 'ground'; stiffness = [50, 90]; damping = [2, 3]; "
                 "rotational_stiffness = 60; rotational_damping = 2") +
         element("motor", "elbow", "a = 'arm'; b = 'post'; constant_effort = 3; derivative = 0.7") +
         element("joint_friction", "stiff pin", "a = 'string'; b = 'kite'; coordinate = 'angle'; holds = 0.4; drags = 0.3");
}

struct Outcome {
  std::vector<double> acceleration, channel, compliance, along;
};

// At the state as `coordinates` have it: what a snapshot shows of all bodies and joints, and how the rows of friction that
// slips would answer to it.
Outcome outcome_at(const System& system, const State& state, Coordinates coordinates) {
  Dynamics dynamics(system);
  dynamics.use_coordinates(coordinates);
  dynamics.set_left_limit_time(state.t + 1.0);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension()), dy(y.size());
  dynamics.pack(state, y.data());
  dynamics.rates(state.t, y.data(), dy.data());
  Outcome outcome;
  Dynamics::ModeProblem candidates;
  for (std::size_t f = 0; f < system.frictions.size(); ++f)
    if (state.friction[f].phase == FrictionPhase::slip) candidates.rows.push_back(system.frictions[f].friction->rows(state.friction[f]));
  dynamics.compute_mode_problem(candidates, dy.data());
  outcome.compliance = candidates.compliance;
  outcome.along = candidates.acceleration;
  const Snapshot snapshot = dynamics.snapshot(dy.data());
  outcome.acceleration.assign(snapshot.acceleration, snapshot.acceleration + 3 * system.bodies.size());
  for (const Channel& channel : system.channels) outcome.channel.push_back(channel.value(snapshot));
  return outcome;
}

} // namespace

// Rounding: the accelerations of some 15 bodies and rows whose condition is below a few thousand.
TEST_CASE("joint coordinates: the same accelerations and reactions in one state") {
  const Model model = scene(everything());
  const auto system = compile(model);
  State state = start_of(model, *system);
  for (const FrictionPhase phase : {FrictionPhase::stick, FrictionPhase::slip}) {
    state.friction[0].phase = phase;
    state.friction[0].sign = 1;
    if (phase == FrictionPhase::stick) { // at rest in the pin, by projection onto its row
      Dynamics dynamics(*system);
      dynamics.set_state(state);
      std::vector<double> y(dynamics.dimension());
      dynamics.pack(state, y.data());
      dynamics.project(0.0, y.data(), 0.0);
      dynamics.unpack(0.0, y.data(), state);
    }
    const Outcome absolute = outcome_at(*system, state, Coordinates::absolute);
    const Outcome joint = outcome_at(*system, state, Coordinates::joint);
    const double size = largest(absolute.acceleration);
    for (std::size_t i = 0; i < absolute.acceleration.size(); ++i)
      CHECK(std::abs(joint.acceleration[i] - absolute.acceleration[i]) < 1e-12 * size);
    for (std::size_t c = 0; c < absolute.channel.size(); ++c) {
      CAPTURE(system->channels[c].name);
      CHECK(std::abs(joint.channel[c] - absolute.channel[c]) < 1e-12 * std::max(size, largest(absolute.channel)));
    }
  }
  // post, arm, tip with tail, strut: 4; cart free: 3; the rod and bob: 2; kite free with string: 4.
  CHECK(count_coordinates(*system, state) == 13);
}

// Of one mechanism, of two, of a free body and of the ground: the answers fill a matrix whose rows mix both descriptions.
TEST_CASE("joint coordinates: friction between whatever hangs where") {
  const std::string all = everything() + element("joint_friction", "arm on strut", "a = 'arm'; b = 'strut'; coordinate = 'x'; holds = 2") +
                          element("joint_friction", "tip on kite", "a = 'tip'; b = 'kite'; coordinate = 'y'; holds = 2") +
                          element("joint_friction", "cart on string", "a = 'cart'; b = 'string'; coordinate = 'x'; holds = 2") +
                          element("joint_friction", "kite on ground", "a = 'kite'; coordinate = 'y'; holds = 2") +
                          element("joint_friction", "cart on ground", "a = 'cart'; coordinate = 'x'; holds = 2");
  const Model model = scene(all);
  const auto system = compile(model);
  State state = start_of(model, *system);
  for (FrictionState& friction : state.friction) {
    friction.phase = FrictionPhase::slip;
    friction.sign = 1;
  }
  const Outcome absolute = outcome_at(*system, state, Coordinates::absolute);
  const Outcome joint = outcome_at(*system, state, Coordinates::joint);
  REQUIRE(absolute.compliance.size() == 36);
  for (std::size_t i = 0; i < 36; ++i) // rounding, as above
    CHECK(std::abs(joint.compliance[i] - absolute.compliance[i]) < 1e-12 * largest(absolute.compliance));
  for (std::size_t i = 0; i < 6; ++i) CHECK(std::abs(joint.along[i] - absolute.along[i]) < 1e-12 * largest(absolute.acceleration));
}

TEST_CASE("joint coordinates: packed and unpacked again, a state on the joints is the same") {
  const Model model = scene(everything());
  const auto system = compile(model);
  const State state = start_of(model, *system);
  Dynamics dynamics(*system);
  dynamics.use_coordinates(Coordinates::joint);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  State again = state;
  dynamics.unpack(0.0, y.data(), again);
  for (std::size_t i = 0; i < state.q.size(); ++i) { // assembled to 1e-12
    CHECK(std::abs(again.q[i] - state.q[i]) < 1e-11);
    CHECK(std::abs(again.v[i] - state.v[i]) < 1e-11);
  }
}

// Central differences of two steps, extrapolated: truncation of order h⁴ and rounding 1e-16/h meet at 1e-9 or so of the
// largest entry.
TEST_CASE("joint coordinates: linearised as differences of the rates tell") {
  constexpr double k_step = 2e-5;
  const Model model = scene(everything());
  const auto system = compile(model);
  State state = start_of(model, *system);
  for (const FrictionPhase phase : {FrictionPhase::stick, FrictionPhase::slip}) {
    state.friction[0].phase = phase;
    state.friction[0].sign = 1;
    Dynamics dynamics(*system);
    dynamics.use_coordinates(Coordinates::joint);
    dynamics.set_state(state);
    std::vector<double> y(dynamics.dimension()), ahead(y), behind(y);
    dynamics.pack(state, y.data());
    Linearization linear;
    linear.evaluate(dynamics, 0.0, y.data());
    MatX exact[2];
    linear.acceleration_by_state(exact[0], exact[1]);
    const int n = dynamics.coordinate_count();
    for (int kind = 0; kind < 2; ++kind) {
      const auto slope = [&](int column, double h) {
        std::vector<double> moved = y;
        moved[kind * n + column] += h;
        dynamics.rates(0.0, moved.data(), ahead.data());
        moved[kind * n + column] -= 2.0 * h;
        dynamics.rates(0.0, moved.data(), behind.data());
        return VecX((VecX::Map(ahead.data() + n, n) - VecX::Map(behind.data() + n, n)) / (2.0 * h));
      };
      MatX by_difference(n, n);
      for (int c = 0; c < n; ++c) by_difference.col(c) = (4.0 * slope(c, k_step) - slope(c, 2.0 * k_step)) / 3.0;
      const double size = std::max(1.0, by_difference.cwiseAbs().maxCoeff());
      CHECK((exact[kind] - by_difference).cwiseAbs().maxCoeff() < 3e-8 * size);
    }
  }
}

// Two runs at 1e-11 each, of some hundred steps, whose errors grow with the motion, most in double pendulum, squeezer
// and chain. The four-bars up to their first flat position, where accelerations are known to rounding over the square
// of the distance.
TEST_CASE("joint coordinates: the same motion, reactions and energies") {
  struct Case {
    const char* model;
    double end;
    double bound;
  };
  for (const Case& c : {Case{"simple_pendulum", 3.0, 1e-8},
                        {"double_pendulum", 2.0, 1e-7},
                        {"andrews", 0.03, 1e-7},
                        {"four_bar_2", 0.6, 1e-8},
                        {"robot_arm", 1.0, 1e-8},
                        {"chain_10", 0.5, 1e-7}}) {
    CAPTURE(std::string(c.model));
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/benchmarks/" + c.model + ".toml", transformer_catalog());
    const auto system = compile(model);
    const RunResult absolute = run_in(model, *system, Coordinates::absolute, 1e-11, c.end);
    const RunResult joint = run_in(model, *system, Coordinates::joint, 1e-11, c.end);
    std::string channel;
    const double worst = difference(*system, absolute, joint, channel);
    CAPTURE(channel);
    CHECK(worst < c.bound);
    CHECK(joint.statistics.energy_residual < 1e-8 * std::max(1.0, joint.statistics.energy_scale));
  }
}

TEST_CASE("joint coordinates: friction in a pin sticks and slides at the same times") {
  const Model model = scene(everything());
  const auto system = compile(model);
  const RunResult absolute = run_in(model, *system, Coordinates::absolute, 1e-11, 1.5);
  const RunResult joint = run_in(model, *system, Coordinates::joint, 1e-11, 1.5);
  REQUIRE(absolute.events.size() == joint.events.size());
  CHECK(absolute.events.size() >= 3);
  for (std::size_t i = 0; i < absolute.events.size(); ++i) {
    CHECK(absolute.events[i].kind == joint.events[i].kind);
    CHECK(absolute.events[i].element == joint.events[i].element);
    CHECK(std::abs(absolute.events[i].t - joint.events[i].t) < 1e-7);
  }
  std::string channel;
  const double worst = difference(*system, absolute, joint, channel);
  CAPTURE(channel);
  CHECK(worst < 1e-6);
}

// A guide keeps its rows where the piston hangs on a mechanism. Two runs at 1e-11 each: as above.
TEST_CASE("joint coordinates: a crank and its piston") {
  const std::string crank =
      "gravity = [0.5, -9.0]\n[simulation]\nstep = 1e-3\n" +
      body("crank", "mass = 2; inertia = 0.3; position = [0.15, 0.1]; angular_velocity = 3") +
      body("conrod", "mass = 1; inertia = 0.1; position = [0.7, 0.1]") +
      body("piston", "mass = 0.6; inertia = 0.1; position = [1.1, 0.0]") +
      element("revolute", "main", "a = { body = 'crank', at = [0, 0] }") +
      element("revolute", "big end", "a = { body = 'conrod', at = [0.3, 0.2] }; b = { body = 'crank', at = [0.3, 0.2] }") +
      element("revolute", "small end", "a = { body = 'piston', at = [1.1, 0] }; b = { body = 'conrod', at = [1.1, 0] }") +
      element("prismatic", "cylinder", "a = 'piston'; axis = [1.0, 0.0]");
  const Model model = scene(crank);
  const auto system = compile(model);
  CHECK(count_coordinates(*system, start_of(model, *system)) == 3);
  const RunResult absolute = run_in(model, *system, Coordinates::absolute, 1e-11, 1.0);
  for (const Coordinates coordinates : {Coordinates::joint, Coordinates::automatic}) {
    std::string channel;
    const double worst = difference(*system, absolute, run_in(model, *system, coordinates, 1e-11, 1.0), channel);
    CAPTURE(channel);
    CHECK(worst < 1e-7);
  }
}

// A bead without weight on a rod that turns at ω: r = r0 cosh ωt, the rod presses with 2 m ω ṙ. 1e-9: the tolerance is 1e-12.
TEST_CASE("a bead on a turning rod, by its closed form") {
  constexpr double k_omega = 2.0, k_mass = 0.8, k_start = 0.3, k_end = 1.2;
  const std::string text = k_no_gravity + "[simulation]\nstep = 1e-3\n" +
                           body("rod", "mass = 3; inertia = 0.4; position = [0, 0]; angular_velocity = 2") +
                           body("bead", "mass = 0.8; inertia = 0.01; position = [0.3, 0]; velocity = [0, 0.6]; angular_velocity = 2") +
                           signal_entry("constant", "zero", "value = 0") + signal_entry("constant", "speed", "value = 2") +
                           element("prescribed_motion", "x", "a = 'rod'; coordinate = 'x'; signal = 'zero'; as = 'velocity'") +
                           element("prescribed_motion", "y", "a = 'rod'; coordinate = 'y'; signal = 'zero'; as = 'velocity'") +
                           element("prescribed_motion", "motor", "a = 'rod'; coordinate = 'angle'; signal = 'speed'; as = 'velocity'") +
                           element("prismatic", "guide", "a = 'bead'; b = 'rod'; axis = [1.0, 0.0]");
  const Model model = scene(text);
  const auto system = compile(model);
  const RunResult result = run_in(model, *system, Coordinates::automatic, 1e-12, k_end);
  const auto last = [&result](const char* name) { return result.trajectory->series(name).back(); };
  const double r = k_start * std::cosh(k_omega * k_end), speed = k_omega * k_start * std::sinh(k_omega * k_end);
  CHECK(std::hypot(last("bead.x"), last("bead.y")) == doctest::Approx(r).epsilon(1e-9));
  CHECK(std::atan2(last("bead.y"), last("bead.x")) == doctest::Approx(k_omega * k_end).epsilon(1e-9));
  CHECK(last("guide.force") == doctest::Approx(2.0 * k_mass * k_omega * speed).epsilon(1e-9));
  // The motor turns bead and guide: couple d/dt (m r² ω).
  CHECK(last("motor.reaction") == doctest::Approx(2.0 * k_mass * k_omega * r * speed).epsilon(1e-9));
}

// Of a mechanism that the program may choose for itself: from a flat position on that joint coordinates do not pass
// bodies' own serve, and where they do, too, the free end comes out where the exact solution has it (as in
// benchmarks_test.cpp, which has tighter tolerances).
TEST_CASE("joint coordinates: flat positions of four-bars are passed, whatever describes them") {
  const Model model = read_model(STEPLAP_MODELS "/benchmarks/four_bar_2.toml", transformer_catalog());
  const auto system = compile(model);
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-11, 1e-12}) {
    CAPTURE(tolerance);
    const RunResult result = run_in(model, *system, Coordinates::automatic, tolerance, 10.0);
    const auto last = [&result](const char* name) { return result.trajectory->series(name).back(); };
    const Vec2 centre(last("rod 0.x"), last("rod 0.y")); // pinned to the ground at the origin, 1 m long
    CHECK((2.0 * centre - Vec2(0.328458111540815, 0.944518538178601)).norm() < std::max(300.0 * tolerance, 1e-10));
  }
}

// Free bodies keep their momentum to rounding, which is linear in absolute coordinates alone: there is no choice to
// make.
TEST_CASE("joint coordinates: chosen for what hangs on the ground, not for drives and free bodies") {
  const auto count = [](const std::string& text, Coordinates coordinates) {
    const auto system = compile(scene(text + "[simulation]\nstep = 1e-3\n"));
    Dynamics dynamics(*system);
    dynamics.use_coordinates(coordinates);
    const State state = system->initial_state();
    dynamics.set_state(state);
    return dynamics.coordinate_count();
  };
  const std::string two =
      body("upper", "mass = 2; inertia = 0.3; position = [0.5, 0]") + body("lower", "mass = 1; inertia = 0.1; position = [1.5, 0]");
  const std::string elbow = element("revolute", "elbow", "a = { body = 'lower', at = [1, 0] }; b = { body = 'upper', at = [1, 0] }");
  const std::string shoulder = element("revolute", "shoulder", "a = { body = 'upper', at = [0, 0] }");
  CHECK(count(two + elbow + shoulder, Coordinates::automatic) == 2);
  CHECK(count(two + elbow + shoulder, Coordinates::absolute) == 6);
  CHECK(count(two + elbow, Coordinates::automatic) == 6);
  CHECK(count(two + elbow, Coordinates::joint) == 4);
  const std::string motor = signal_entry("constant", "speed", "value = 1") +
                            element("prescribed_motion", "motor", "a = 'upper'; coordinate = 'angle'; signal = 'speed'; as = 'velocity'");
  CHECK(count(two + elbow + shoulder + motor, Coordinates::joint) == 6);
  std::string chain = two;
  for (int i = 0; i < 16; ++i) chain += body("b" + std::to_string(i), "mass = 1; inertia = 0.1; position = [0, 0]");
  for (int i = 0; i + 1 < 16; ++i)
    chain += element("revolute", "j" + std::to_string(i), "a = 'b" + std::to_string(i + 1) + "'; b = 'b" + std::to_string(i) + "'");
  chain += element("revolute", "first", "a = 'b0'");
  CHECK(count(chain, Coordinates::automatic) == 16 + 6);
  CHECK(count(chain + elbow + shoulder + element("revolute", "last", "a = 'upper'; b = 'b15'"), Coordinates::automatic) == 54);
}

// The implicit method's steps use the linearisation; 1e-7 is a hundred times its tolerance.
TEST_CASE("joint coordinates: the implicit method") {
  const Model model = scene(everything());
  const auto system = compile(model);
  SimulationOptions o = options({"rodas5p", 1e-9, 0.5, 0.05});
  std::vector<RunResult> results;
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
    o.coordinates = coordinates;
    results.push_back(simulate(*system, start_of(model, *system), o));
  }
  std::string channel;
  const double worst = difference(*system, results[0], results[1], channel);
  CAPTURE(channel);
  CHECK(worst < 1e-6);
}
