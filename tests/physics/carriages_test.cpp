// Bodies on guides, described by how far they have slid (mbd/dynamics/carriage.h), against the same bodies in absolute
// coordinates with the guides' rows: two ways to the same accelerations, reactions and motions, which share the forces of
// elements and nothing else of the way to accelerations. And against a closed form.
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

// A table that turns freely on springs carries a sled (with a rider welded to it, off its centre; friction in the guide) and a
// shuttle, of which it is the guide's a; a body led by a point of the table and a wheel that is driven against it make rows on
// the carrier. A bolt slides on the ground, a roof on a car that is driven.
std::string guides() {
  return "gravity = [1.0, -9.0]\n[simulation]\nstep = 1e-3\n" +
         body("table", "mass = 4; inertia = 0.6; position = [0.2, 0.5]; angle = 0.3; angular_velocity = 1.4") +
         body("sled", "mass = 2; inertia = 0.3; position = [0.9, 0.8]; angle = -0.2; velocity = [0.6, 0.2]") +
         body("rider", "mass = 0.7; inertia = 0.05; position = [1.3, 1.1]; angle = 0.4") +
         body("shuttle", "mass = 1; inertia = 0.1; position = [-0.6, 0.3]; angle = 0.8; velocity = [0.3, 0.9]") +
         body("follower", "mass = 0.9; inertia = 0.08; position = [0.1, 1.2]; angular_velocity = 0.5") +
         body("wheel", "mass = 0.5; inertia = 0.02; position = [-0.3, 1.0]; velocity = [0.1, 0.1]") +
         body("bolt", "mass = 1.4; inertia = 0.2; position = [2.4, 1.5]; angle = 0.1; velocity = [0.2, 0.1]") +
         body("car", "mass = 3; inertia = 0.5; position = [4.0, 0.5]; velocity = [0.7, 0.1]; angular_velocity = 0.2") +
         body("roof", "mass = 1.1; inertia = 0.15; position = [4.1, 1.5]; velocity = [0.4, 0.2]") +
         signal_entry("harmonics", "shake", "amplitudes = [3]; frequencies = [1.1]; phases = [0.4]") +
         signal_entry("harmonics", "turn", "amplitudes = [2]; frequencies = [0.7]; phases = [0.2]") +
         element("weld", "seat", "a = 'rider'; b = 'sled'") +
         element("prismatic", "sled guide",
                 "a = { body = 'sled', at = [1.0, 0.9] }; b = { body = 'table', at = [0.4, 0.6] }; axis = [0.6, 0.8]") +
         element("prismatic", "shuttle guide",
                 "a = { body = 'table', at = [-0.2, 0.4] }; b = { body = 'shuttle', at = [-0.5, 0.1] }; axis = [-0.8, 0.6]") +
         element("point_on_line", "slot",
                 "a = { body = 'follower', at = [0.2, 1.0] }; b = { body = 'table', at = [0.3, 0.7] }; axis = [1.0, 0.2]") +
         element("prescribed_motion", "gear", "a = 'wheel'; b = 'table'; coordinate = 'angle'; signal = 'turn'") +
         element("prismatic", "bolt guide", "a = 'bolt'; b = { body = 'ground', at = [2.0, 1.0] }; axis = [0.28, 0.96]") +
         element("prescribed_motion", "vehicle", "a = 'car'; coordinate = 'x'; signal = 'shake'") +
         element("prismatic", "roof guide", "a = 'roof'; b = 'car'; axis = [1.0, 0.0]") +
         element("bushing", "mount",
                 "a = { body = 'table', at = [0.1, 0.4] }; b = 'ground'; stiffness = [50, 90]; damping = [2, 3]; "
                 "rotational_stiffness = 6; rotational_damping = 0.3") +
         element("bushing", "tyres",
                 "a = { body = 'car', at = [4.3, 0.0] }; b = 'ground'; stiffness = [0, 400]; damping = [0, 3]; "
                 "rotational_stiffness = 60; rotational_damping = 2") +
         element("spring_damper", "sled spring",
                 "a = { body = 'sled', at = [0.8, 0.8] }; b = { body = 'table', at = [0.0, 0.2] }; stiffness = 60; damping = 1") +
         element("spring_damper", "shuttle spring",
                 "a = { body = 'shuttle', at = [-0.7, 0.2] }; b = { body = 'rider', at = [1.2, 1.0] }; stiffness = 40; "
                 "damping = 2") +
         element("spring_damper", "follower spring",
                 "a = { body = 'follower', at = [0.0, 1.3] }; b = { body = 'bolt', at = [2.4, 1.4] }; stiffness = 30; "
                 "damping = 2") +
         element("spring_damper", "wheel spring",
                 "a = { body = 'wheel', at = [-0.3, 1.0] }; b = { body = 'table', at = [-0.4, 0.8] }; stiffness = 90; "
                 "damping = 2") +
         element("bushing", "roof mount",
                 "a = { body = 'roof', at = [4.0, 1.2] }; b = { body = 'car', at = [4.0, 1.2] }; stiffness = [80, 0]; "
                 "damping = [2, 0]; rotational_stiffness = 0; rotational_damping = 0") +
         element("joint_friction", "rust",
                 "a = 'sled'; b = 'table'; coordinate = 'distance'; holds = 9; drags = 6");
}

// With drives where they begin, as a run has it.
State state_of(const Model& model, const System& system) {
  State state = start_of(model, system);
  start_drives(system, state);
  return state;
}

// Sticking from here on, at rest along the guide.
void stick(const System& system, State& state) {
  state.friction[0].phase = FrictionPhase::stick;
  Dynamics dynamics(system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension()), dy(y.size());
  dynamics.pack(state, y.data());
  dynamics.rates(0.0, y.data(), dy.data());
  const RowSpec& row = system.frictions[0].friction->rows(state.friction[0])[0];
  state.memory[row.memory] = evaluate_row<false>(row, dynamics.motion().data()).value;
  dynamics.project(0.0, y.data(), 0.0);
  dynamics.unpack(0.0, y.data(), state);
}

struct Outcome {
  std::vector<double> acceleration, channel, compliance, along;
};

// At the state as `coordinates` have it: what a snapshot shows of all bodies and joints, and how friction's rows would answer.
Outcome outcome_at(const System& system, const State& state, Coordinates coordinates) {
  Dynamics dynamics(system);
  dynamics.use_coordinates(coordinates);
  dynamics.set_time_limit(state.t + 1.0);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension()), dy(y.size());
  dynamics.pack(state, y.data());
  dynamics.rates(state.t, y.data(), dy.data());
  Outcome outcome;
  Dynamics::Candidates candidates;
  for (std::size_t f = 0; f < system.frictions.size(); ++f)
    if (state.friction[f].phase == FrictionPhase::slip)
      candidates.rows.push_back(system.frictions[f].friction->rows(state.friction[f]));
  dynamics.respond(candidates, dy.data());
  outcome.compliance = candidates.compliance;
  outcome.along = candidates.acceleration;
  const Snapshot snapshot = dynamics.snapshot(dy.data());
  outcome.acceleration.assign(snapshot.acceleration, snapshot.acceleration + 3 * system.bodies.size());
  for (const Channel& channel : system.channels) outcome.channel.push_back(channel.value(snapshot));
  return outcome;
}

void check_same_run(const Model& model, Coordinates coordinates, double tolerance, double end, double bound,
                    std::size_t least_events = 0) {
  const auto system = compile(model);
  const RunResult absolute = run_in(model, *system, Coordinates::absolute, tolerance, end);
  const RunResult joint = run_in(model, *system, coordinates, tolerance, end);
  REQUIRE(absolute.events.size() == joint.events.size());
  CHECK(absolute.events.size() >= least_events);
  for (std::size_t i = 0; i < absolute.events.size(); ++i) {
    CHECK(absolute.events[i].kind == joint.events[i].kind);
    CHECK(absolute.events[i].element == joint.events[i].element);
    CHECK(std::abs(absolute.events[i].t - joint.events[i].t) < bound);
  }
  std::string channel;
  const double worst = difference(*system, absolute, joint, channel);
  CAPTURE(channel);
  CHECK(worst < bound);
  CHECK(joint.statistics.energy_residual < 1e-8 * std::max(1.0, joint.statistics.energy_scale));
}

} // namespace

// Rounding: the accelerations of some ten bodies and rows whose condition is below a few thousand.
TEST_CASE("carriages: the same accelerations, reactions and answers to friction in one state") {
  const Model model = scene(guides());
  const auto system = compile(model);
  State state = state_of(model, *system);
  for (const FrictionPhase phase : {FrictionPhase::stick, FrictionPhase::slip}) {
    state.friction[0].phase = phase;
    state.friction[0].sign = 1;
    if (phase == FrictionPhase::stick) stick(*system, state);
    const Outcome absolute = outcome_at(*system, state, Coordinates::absolute);
    const Outcome joint = outcome_at(*system, state, Coordinates::joint);
    const double size = largest(absolute.acceleration);
    for (std::size_t i = 0; i < absolute.acceleration.size(); ++i)
      CHECK(std::abs(joint.acceleration[i] - absolute.acceleration[i]) < 1e-12 * size);
    for (std::size_t c = 0; c < absolute.channel.size(); ++c) {
      CAPTURE(system->channels[c].name);
      CHECK(std::abs(joint.channel[c] - absolute.channel[c]) < 1e-12 * std::max(size, largest(absolute.channel)));
    }
    for (std::size_t i = 0; i < absolute.compliance.size(); ++i)
      CHECK(joint.compliance[i] == doctest::Approx(absolute.compliance[i]).epsilon(1e-12));
    for (std::size_t i = 0; i < absolute.along.size(); ++i) CHECK(std::abs(joint.along[i] - absolute.along[i]) < 1e-12 * size);
  }
  // table, follower, wheel, car: 3 each; shuttle, bolt, roof: 1 each; the sled 1 as long as its friction slides.
  CHECK(count_coordinates(*system, state) == 16);
  state.friction[0].phase = FrictionPhase::stick;
  CHECK(count_coordinates(*system, state) == 18);
  // Left to the program slides are none.
  CHECK(count_coordinates(*system, state, Coordinates::automatic) == 24);
  CHECK(count_coordinates(*system, state, Coordinates::absolute) == 24);
}

// Rows of friction between bodies on one carrier, on two, and on none: all answer as in absolute coordinates.
TEST_CASE("carriages: friction between whatever stands where") {
  const std::string all = guides() +
                          element("joint_friction", "shuttle on sled", "a = 'shuttle'; b = 'sled'; coordinate = 'x'; holds = 2") +
                          element("joint_friction", "roof on bolt", "a = 'roof'; b = 'bolt'; coordinate = 'y'; holds = 2") +
                          element("joint_friction", "rider on table", "a = 'rider'; b = 'table'; coordinate = 'x'; holds = 2") +
                          element("joint_friction", "follower on roof", "a = 'follower'; b = 'roof'; coordinate = 'x'; holds = 2") +
                          element("joint_friction", "car on ground", "a = 'car'; coordinate = 'y'; holds = 2");
  const Model model = scene(all);
  const auto system = compile(model);
  State state = state_of(model, *system);
  for (FrictionState& friction : state.friction) {
    friction.phase = FrictionPhase::slip;
    friction.sign = 1;
  }
  CHECK(count_coordinates(*system, state) == 16);
  const Outcome absolute = outcome_at(*system, state, Coordinates::absolute);
  const Outcome joint = outcome_at(*system, state, Coordinates::joint);
  REQUIRE(absolute.compliance.size() == 36);
  for (std::size_t i = 0; i < 36; ++i) // as above
    CHECK(std::abs(joint.compliance[i] - absolute.compliance[i]) < 1e-12 * largest(absolute.compliance));
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(std::abs(joint.along[i] - absolute.along[i]) < 1e-12 * largest(absolute.acceleration));
}

TEST_CASE("carriages: packed and unpacked again, a state on the guides is the same") {
  const Model model = scene(guides());
  const auto system = compile(model);
  State state = state_of(model, *system);
  state.friction[0].phase = FrictionPhase::slip;
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

// What a projection changes is least in the masses' metric, in whatever coordinates: the mean of what absolute coordinates
// are given is on the guides, so that both may go the same way.
TEST_CASE("carriages: velocities come to the rows of their carrier in the same way") {
  const Model model = scene(guides());
  const auto system = compile(model);
  State state = state_of(model, *system);
  state.friction[0].phase = FrictionPhase::slip;
  state.friction[0].sign = 1;
  std::vector<State> projected;
  for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
    Dynamics dynamics(*system);
    dynamics.use_coordinates(coordinates);
    dynamics.set_state(state);
    std::vector<double> y(dynamics.dimension());
    State off = state; // the follower, which no guide holds, leaves its slot and takes the table along
    off.v[3 * 5] += 0.3;
    off.v[3 * 5 + 1] -= 0.4;
    dynamics.pack(off, y.data());
    dynamics.project(0.0, y.data(), 0.0);
    dynamics.unpack(0.0, y.data(), off);
    projected.push_back(off);
  }
  double moved = 0.0;
  for (std::size_t i = 0; i < state.v.size(); ++i) {
    CHECK(std::abs(projected[0].v[i] - projected[1].v[i]) < 1e-12);
    if (i < 12) moved = std::max(moved, std::abs(projected[0].v[i] - state.v[i]));
  }
  CHECK(moved > 0.01);
}

// Central differences of two steps, extrapolated: truncation of order h⁴ and rounding 1e-16/h meet at 1e-9 or so of the
// largest entry.
TEST_CASE("carriages: linearised as differences of the rates tell") {
  constexpr double k_step = 2e-5;
  const Model model = scene(guides());
  const auto system = compile(model);
  State state = state_of(model, *system);
  state.friction[0].phase = FrictionPhase::slip;
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
  const std::vector<double>& w = dynamics.layout().inverse_mass;
  for (int kind = 0; kind < 2; ++kind) {
    const auto slope = [&](int column, double h) {
      std::vector<double> moved = y;
      moved[kind * n + column] += h;
      dynamics.rates(0.0, moved.data(), ahead.data());
      moved[kind * n + column] -= 2.0 * h;
      dynamics.rates(0.0, moved.data(), behind.data());
      return VecX((VecX::Map(ahead.data() + n, n) - VecX::Map(behind.data() + n, n)) / (2.0 * h));
    };
    MatX by_difference = MatX::Zero(n, n);
    for (int c = 0; c < n; ++c)
      if (w[c] > 0.0) by_difference.col(c) = (4.0 * slope(c, k_step) - slope(c, 2.0 * k_step)) / 3.0;
    const double size = std::max(1.0, by_difference.cwiseAbs().maxCoeff());
    for (int c = 0; c < n; ++c) {
      CAPTURE(kind);
      CAPTURE(c);
      CHECK((exact[kind] - by_difference).col(c).cwiseAbs().maxCoeff() < 3e-8 * size);
    }
  }
}

// Two runs at 1e-11 each, of some hundred steps, with friction that sticks and slides on a turning guide: positions, reactions,
// energies and the times of events.
TEST_CASE("carriages: the same motion, reactions, energies and events") {
  check_same_run(scene(guides()), Coordinates::joint, 1e-11, 1.5, 1e-7, 3);
}

TEST_CASE("carriages: the paper's transformer, in all three conditions") {
  for (const char* name : {"no_interference", "interference", "weak_clamping"}) {
    CAPTURE(std::string(name));
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/paper/" + name + ".toml", transformer_catalog());
    const auto system = compile(model);
    // Active part with its limbs, lower tank: 3 each; upper tank: 1.
    CHECK(count_coordinates(*system, system->initial_state()) == 7);
    CHECK(count_coordinates(*system, system->initial_state(), Coordinates::absolute) == 9);
    // Contacts and frictions of 1e9 N/m: a reaction is known to 1e-11 of what the bodies weigh, over the slip's stiffness.
    check_same_run(model, Coordinates::joint, 1e-11, 0.3, 1e-6, 4);
  }
}

// A bead without weight on a rod that turns at ω: r = r0 cosh ωt, the rod presses with 2 m ω ṙ. 1e-9: the tolerance is 1e-12.
TEST_CASE("carriages: a bead on a turning rod, by its closed form") {
  constexpr double k_omega = 2.0, k_mass = 0.8, k_start = 0.3, k_end = 1.2;
  const std::string text =
      k_no_gravity + "[simulation]\nstep = 1e-3\n" +
      body("rod", "mass = 3; inertia = 0.4; position = [0, 0]; angular_velocity = 2") +
      body("bead", "mass = 0.8; inertia = 0.01; position = [0.3, 0]; velocity = [0, 0.6]; angular_velocity = 2") +
      signal_entry("constant", "zero", "value = 0") + signal_entry("constant", "speed", "value = 2") +
      element("prescribed_motion", "x", "a = 'rod'; coordinate = 'x'; signal = 'zero'; as = 'velocity'") +
      element("prescribed_motion", "y", "a = 'rod'; coordinate = 'y'; signal = 'zero'; as = 'velocity'") +
      element("prescribed_motion", "motor", "a = 'rod'; coordinate = 'angle'; signal = 'speed'; as = 'velocity'") +
      element("prismatic", "guide", "a = 'bead'; b = 'rod'; axis = [1.0, 0.0]");
  const Model model = scene(text);
  const auto system = compile(model);
  CHECK(count_coordinates(*system, system->initial_state()) == 4);
  const RunResult result = run_in(model, *system, Coordinates::joint, 1e-12, k_end);
  const auto last = [&result](const char* name) { return result.trajectory->series(name).back(); };
  const double r = k_start * std::cosh(k_omega * k_end), speed = k_omega * k_start * std::sinh(k_omega * k_end);
  CHECK(std::hypot(last("bead.x"), last("bead.y")) == doctest::Approx(r).epsilon(1e-9));
  CHECK(std::atan2(last("bead.y"), last("bead.x")) == doctest::Approx(k_omega * k_end).epsilon(1e-9));
  CHECK(last("guide.force") == doctest::Approx(2.0 * k_mass * k_omega * speed).epsilon(1e-9));
  // The motor turns bead and guide: couple d/dt (m r² ω).
  CHECK(last("motor.reaction") == doctest::Approx(2.0 * k_mass * k_omega * r * speed).epsilon(1e-9));
}

// What is not described by a slide keeps its rows: a guide upon a guide, a piston, a slider that is driven, two guides side by side.
TEST_CASE("carriages: guides in chains, loops and drives agree, too") {
  const std::string free_run = "gravity = [0.5, -9.0]\n[simulation]\nstep = 1e-3\n";
  const std::string chain =
      free_run + body("low", "mass = 2; inertia = 0.3; position = [0.5, 0]; velocity = [0.3, 0.0]") +
      body("high", "mass = 1; inertia = 0.1; position = [0.7, 0.6]; velocity = [0.3, 0.2]") +
      body("top", "mass = 0.6; inertia = 0.1; position = [0.9, 0.9]; velocity = [0.1, 0.2]") +
      element("prismatic", "ground guide", "a = 'low'; axis = [0.8, 0.6]") +
      element("prismatic", "low guide", "a = 'high'; b = 'low'; axis = [-0.6, 0.8]") +
      element("prismatic", "high guide", "a = 'high'; b = 'top'; axis = [1.0, 0.0]") +
      element("spring_damper", "tie", "a = 'top'; b = 'ground'; stiffness = 40; damping = 1") +
      element("spring_damper", "brace", "a = 'high'; b = { body = 'ground', at = [0, 1] }; stiffness = 60; damping = 1");
  check_same_run(scene(chain), Coordinates::joint, 1e-11, 1.0, 1e-8);
  const std::string crank =
      free_run + body("crank", "mass = 2; inertia = 0.3; position = [0.15, 0.1]; angular_velocity = 3") +
      body("conrod", "mass = 1; inertia = 0.1; position = [0.7, 0.1]") +
      body("piston", "mass = 0.6; inertia = 0.1; position = [1.1, 0.0]") +
      element("revolute", "main", "a = { body = 'crank', at = [0, 0] }") +
      element("revolute", "big end", "a = { body = 'conrod', at = [0.3, 0.2] }; b = { body = 'crank', at = [0.3, 0.2] }") +
      element("revolute", "small end", "a = { body = 'piston', at = [1.1, 0] }; b = { body = 'conrod', at = [1.1, 0] }") +
      element("prismatic", "cylinder", "a = 'piston'; axis = [1.0, 0.0]");
  for (const Coordinates coordinates : {Coordinates::joint, Coordinates::automatic})
    check_same_run(scene(crank), coordinates, 1e-11, 1.0, 1e-7);
  const std::string driven =
      guides() + element("prescribed_motion", "pusher",
                         "a = { body = 'shuttle', at = [-0.6, 0.3] }; b = { body = 'table', at = [0.2, 0.5] }; coordinate = "
                         "'distance'; signal = 'turn'; as = 'acceleration'");
  check_same_run(scene(driven), Coordinates::joint, 1e-11, 0.5, 1e-7);
  const std::string twice =
      guides() + element("prismatic", "second guide", "a = 'roof'; b = 'car'; axis = [1.0, 0.0]");
  check_same_run(scene(twice), Coordinates::joint, 1e-11, 0.5, 1e-6);
}

// The implicit method's steps use the linearisation; 1e-6 is a thousand times its tolerance.
TEST_CASE("carriages: the implicit method") {
  const Model model = scene(guides());
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
