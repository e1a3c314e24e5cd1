// What an evaluation leaves, and for how long: multipliers, motions, forces of bodies that change their company.
#include "mbd/dynamics/dynamics.h"
#include "mbd/io/reader.h"
#include "mbd/tape/machine_code.h"
#include "tests/elements/step_lap/step_lap_scene.h"
#include "tests/physics/scene.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A rod of 2 kg on a pin through its end, and a small body welded to its other end that nothing else touches.
const char* k_pendulum = R"([simulation]
step = 1e-3
[[body]]
name = "rod"
mass = 2.0
inertia = 0.3
position = [0.5, 0.0]
[[body]]
name = "bob"
mass = 1.0
inertia = 0.1
position = [1.0, 0.2]
angle = 0.4
[[marker]]
name = "bob's"
body = "rod"
at = [0.5, 0.2]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "rod", at = [0.0, 0.0] }
b = { body = "ground", at = [0.0, 0.0] }
[[element]]
kind = "weld"
name = "weld"
a = "bob's"
b = "bob"
)";

struct EvaluatedScene {
  std::unique_ptr<System> system;
  State state;
  Dynamics dynamics;
  std::vector<double> y, dy;

  explicit EvaluatedScene(const std::string& text)
      : system(compile(scene(text))), state(system->initial_state()), dynamics(*system), y(system->largest_dimension()), dy(y.size()) {
    dynamics.set_state(state);
    dynamics.pack(state, y.data());
    dynamics.rates(0.0, y.data(), dy.data());
  }
};

} // namespace

TEST_CASE("multipliers are those of the last evaluation, whatever is projected or asked since") {
  EvaluatedScene e(k_pendulum);
  const std::vector<double> lambda = e.dynamics.multipliers();
  REQUIRE(e.dynamics.layout().active.size() == 2);
  // The pin bears the weight less what falls: not zero, so that a residual in its place would show.
  REQUIRE(std::abs(lambda[1]) > 1.0);
  std::vector<double> off = e.y;
  off[0] += 1e-3;
  off[1] -= 2e-3;
  e.dynamics.project(0.0, off.data(), 1e-12);
  CHECK(e.dynamics.multipliers() == lambda);
  std::vector<double> change(e.y.size(), 1e-3);
  e.dynamics.project_onto_null_space(change.data());
  CHECK(e.dynamics.multipliers() == lambda);
  const RowSpec* const row = e.dynamics.layout().active[0].spec;
  Dynamics::ModeProblem candidates;
  candidates.rows = {row};
  e.dynamics.rates(0.0, e.y.data(), e.dy.data());
  e.dynamics.compute_mode_problem(candidates, e.dy.data());
  CHECK(e.dynamics.multipliers() == lambda);
}

TEST_CASE("results are refused before the level that contains them is reached") {
  EvaluatedScene e(k_pendulum);
  Dynamics::ModeProblem candidates;
  candidates.rows = {e.dynamics.layout().active[0].spec};
  const auto evaluated = [&](Request request) { e.dynamics.evaluate(request, 0.0, e.y.data(), e.dy.data()); };
  const auto has_motion = [&] {
    try {
      return !e.dynamics.motion().empty() && e.dynamics.evaluation().t == 0.0;
    } catch (const std::logic_error&) {
      return false;
    }
  };
  const auto has_rates = [&] { // of functions that need rates, all or none work
    int refused = 0;
    const auto count = [&refused](const auto& call) {
      try {
        call();
      } catch (const std::logic_error&) {
        ++refused;
      }
    };
    count([&] { e.dynamics.compute_mode_problem(candidates, e.dy.data()); });
    count([&] { (void)e.dynamics.snapshot(e.dy.data()); });
    CHECK(refused % 2 == 0);
    return refused == 0;
  };
  CHECK(has_motion());
  CHECK(has_rates());
  e.dynamics.set_state(e.state);
  CHECK_FALSE(has_motion());
  CHECK_FALSE(has_rates());
  e.dynamics.project(0.0, e.y.data(), 1e-12); // the pin is a row: its residual needs the motion
  CHECK(has_motion());
  CHECK_FALSE(has_rates());
  evaluated(Request::end);
  CHECK(has_rates());
  for (const Request stage : {Request::stage, Request::stage_near_limit, Request::stage_and_joints}) { // with machine code or without
    evaluated(stage);
    CHECK_FALSE(has_motion());
    CHECK_FALSE(has_rates());
  }
  evaluated(Request::rates);
  CHECK(has_rates());
}

TEST_CASE("every body is where it moves to and accelerates as its neighbours let it, also those that no force acts on") {
  EvaluatedScene e(k_pendulum);
  REQUIRE(e.dynamics.layout().riding_along.size() + e.dynamics.layout().riding.size() > 0);
  const double quarter = 0.5 * std::acos(-1.0);
  for (const double angle : {0.0, 0.3, quarter}) {
    // Turned about the pin at (0, 0), and turning: all of it is a rigid motion.
    State turned = e.state;
    const double c = std::cos(angle), s = std::sin(angle), omega = 0.7;
    for (int i = 1; i < e.system->body_count(); ++i) {
      const double x = e.state.q[3 * i], y = e.state.q[3 * i + 1];
      turned.q[3 * i] = c * x - s * y;
      turned.q[3 * i + 1] = s * x + c * y;
      turned.q[3 * i + 2] += angle;
      turned.v[3 * i] = -omega * turned.q[3 * i + 1];
      turned.v[3 * i + 1] = omega * turned.q[3 * i];
      turned.v[3 * i + 2] = omega;
    }
    e.dynamics.pack(turned, e.y.data());
    e.dynamics.rates(0.0, e.y.data(), e.dy.data());
    const std::vector<Motion<double>>& motion = e.dynamics.motion();
    for (int i = 1; i < e.system->body_count(); ++i) { // to a few roundings of metres
      CHECK(std::abs(motion[i].x - turned.q[3 * i]) < 1e-15);
      CHECK(std::abs(motion[i].y - turned.q[3 * i + 1]) < 1e-15);
      CHECK(std::abs(motion[i].vx - turned.v[3 * i]) < 1e-15);
      CHECK(std::abs(motion[i].omega - omega) < 1e-15);
      CHECK(std::abs(motion[i].c - std::cos(turned.q[3 * i + 2])) < 1e-15);
      CHECK(std::abs(motion[i].s - std::sin(turned.q[3 * i + 2])) < 1e-15);
      CHECK(e.dynamics.evaluation().motion[i].y == motion[i].y);
    }
    const double* const acceleration = e.dynamics.snapshot(e.dy.data()).acceleration;
    const double alpha = acceleration[5]; // of all of them, about the pin; rounding of some m/s²
    for (int i = 1; i < e.system->body_count(); ++i) {
      const double x = turned.q[3 * i], y = turned.q[3 * i + 1];
      CHECK(std::abs(acceleration[3 * i] - (-alpha * y - omega * omega * x)) < 1e-13);
      CHECK(std::abs(acceleration[3 * i + 1] - (alpha * x - omega * omega * y)) < 1e-13);
      CHECK(acceleration[3 * i + 2] == alpha);
    }
    CHECK(std::abs(alpha) > 0.5);
  }
}

// The limbs slide on the yokes, then hold to them: bodies that friction acts on, then parts of a core that nothing acts on.
// Springs make the energy hang on every place.
TEST_CASE("energy is that of the state that is asked for, wherever bodies were at the last evaluation") {
  const std::string text = std::string(k_pendulum) + R"([[body]]
name = "ball"
mass = 0.7
inertia = 0.2
position = [0.4, -1.0]
[[element]]
kind = "bushing"
name = "mount"
a = "ball"
b = "ground"
stiffness = [300.0, 500.0]
rotational_stiffness = 40.0
[[element]]
kind = "spring_damper"
name = "spring"
a = { body = "rod", at = [0.2, 0.1] }
b = { body = "ball", at = [0.1, 0.1] }
stiffness = 200.0
)";
  const auto system = compile(scene(text));
  const State state = system->initial_state();
  for (const Coordinates choice : {Coordinates::absolute, Coordinates::joint}) {
    Dynamics dynamics(*system), fresh(*system);
    for (Dynamics* one : {&dynamics, &fresh}) {
      one->use_coordinates(choice);
      one->set_state(state);
    }
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
    dynamics.pack(state, y.data());
    for (int i = 0; i < 2 * dynamics.coordinate_count(); ++i) y[i] += 0.3 + 0.01 * i; // nothing at rest
    const double energy = fresh.mechanical_energy(0.0, y.data());
    for (int i = 0; i < 2 * dynamics.coordinate_count(); ++i) {
      CAPTURE(i);
      dynamics.rates(0.0, y.data(), dy.data());
      CHECK(dynamics.mechanical_energy(0.0, y.data()) == energy);
      std::vector<double> other = y;
      other[i] += 0.05;
      const double expected = fresh.mechanical_energy(0.0, other.data());
      CHECK(expected != energy);
      CHECK(dynamics.mechanical_energy(0.0, other.data()) == expected);
    }
  }
}

TEST_CASE("what acted on a body in other modes acts no more when it rides on another") {
  const auto system = compile(read_model(STEPLAP_MODELS "/paper/no_interference.toml", transformer_catalog()));
  const State holding = system->initial_state();
  State sliding = holding;
  int joints = 0;
  for (std::size_t f = 0; f < system->frictions.size(); ++f) {
    if (system->frictions[f].friction->dimension() == 1) continue;
    sliding.friction[f].phase = FrictionPhase::slip;
    sliding.friction[f].is_onset = true;
    sliding.friction[f].direction[0] = 1.0;
    ++joints;
  }
  REQUIRE(joints == 2);
  const auto wrenches = [&system](Dynamics& dynamics, const State& state) {
    std::vector<double> y(system->largest_dimension()), dy(y.size());
    dynamics.set_state(state);
    dynamics.pack(state, y.data());
    dynamics.rates(0.0, y.data(), dy.data());
    const Snapshot snapshot = dynamics.snapshot(dy.data());
    return std::vector<double>(snapshot.friction_force, snapshot.friction_force + system->friction_row_count);
  };
  Dynamics used(*system), fresh(*system);
  REQUIRE(wrenches(used, sliding) != wrenches(fresh, holding));
  CHECK(wrenches(used, holding) == wrenches(fresh, holding));
}

TEST_CASE("a snapshot shows the energies that the state has booked") {
  EvaluatedScene e(k_pendulum);
  const std::size_t booked = 2 * static_cast<std::size_t>(e.dynamics.coordinate_count());
  e.y[booked] = 3.5;
  e.y[booked + 1] = -2.25;
  e.dynamics.rates(0.0, e.y.data(), e.dy.data());
  const Snapshot snapshot = e.dynamics.snapshot(e.dy.data());
  CHECK(snapshot.dissipated == 3.5);
  CHECK(snapshot.work == -2.25);
}

namespace {

// A limb of 10 kg that a joint of 400 N holds to a yoke of 30 kg, drawn by a spring of 10 kN/m along x: of what the spring pulls, the joint
// bears three quarters.
std::string drawn_limb() {
  using namespace step_lap_scene;
  return header("end = 0.01", 0.01) + body("limb", 10.0, 1.0, {0.0, 0.0}) + body("yoke", 30.0, 3.0, {0.0, 0.0}) + joint("limb", "yoke") +
         interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 5e4, 0.4) +
         "[[element]]\nkind = \"spring_damper\"\nname = \"rope\"\na = { body = \"limb\", at = [0.0, 0.0] }\n"
         "b = { body = \"ground\", at = [2.0, 0.0] }\nstiffness = 1e4\n";
}

} // namespace

// Whether stages look at a merged joint hangs on both ends of the step before; by code or not.
TEST_CASE("a joint inside a cluster is looked at from one step's end near its limit to the second one that is far from it") {
  const auto system = compile(scene(drawn_limb()));
  const State state = system->initial_state();
  for (const StageCode code : {StageCode::never, StageCode::at_once}) {
    Dynamics dynamics(*system);
    dynamics.use_stage_code(code);
    dynamics.set_state(state);
    REQUIRE(dynamics.layout().merged.size() == 1);
    std::vector<double> y(system->largest_dimension()), dy(y.size());
    dynamics.pack(state, y.data());
    dynamics.begin_stages();
    const double x = y[0];
    const double* const event_value = &dynamics.event_value()[static_cast<std::size_t>(system->frictions[0].first_event)];
    const auto at = [&](Request request, double force) {
      y[0] = x - force / 1e4;
      dynamics.evaluate(request, 0.0, y.data(), dy.data());
    };
    const auto left_of = [&](double force) { // of its capacity, the share that is left
      at(Request::end, force);
      return std::min(event_value[0], event_value[1]);
    };
    // Of stages nobody looks at the joint; code is made of them all the same, and is believed for what it finds there.
    for (int stage = 0; stage < 6; ++stage) at(Request::stage, 10.0 + stage);
    CHECK((dynamics.coded_stages() > 0) == (code == StageCode::at_once && MachineCode::is_available()));
    CHECK(!dynamics.needs_rigid_joint_events(false));
    CHECK(std::abs(left_of(40.0) - (1.0 - 0.75 * 40.0 / 400.0)) < 1e-6); // known to the polygons' sums
    CHECK(!dynamics.needs_rigid_joint_events(false));
    CHECK(left_of(440.0) < 0.5);
    CHECK(dynamics.needs_rigid_joint_events(false));
    CHECK(left_of(44.0) > 0.5);
    CHECK(dynamics.needs_rigid_joint_events(false)); // the step that ends here began near the limit
    CHECK(left_of(48.0) > 0.5);
    CHECK(!dynamics.needs_rigid_joint_events(false));
  }
}

TEST_CASE("a body that is driven along one coordinate accelerates freely along the others") {
  const char* const coordinates[3] = {"x", "y", "angle"};
  for (int driven = 0; driven < 3; ++driven) {
    CAPTURE(driven);
    const std::string text = std::string(R"(gravity = [0.0, 0.0]
[simulation]
step = 1e-3
[[signal]]
name = "still"
kind = "constant"
value = 0.0
[[body]]
name = "block"
mass = 2.0
inertia = 0.5
[[element]]
kind = "load"
name = "pull"
at = "block"
force = [3.0, -5.0]
couple = 2.0
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "block"
signal = "still"
coordinate = )") + "\"" + coordinates[driven] +
                             "\"\n";
    EvaluatedScene e(text);
    REQUIRE(e.dynamics.layout().locks.size() == 1);
    const double wanted[3] = {3.0 / 2.0, -5.0 / 2.0, 2.0 / 0.5};
    for (int c = 0; c < 3; ++c) CHECK(e.dy[static_cast<std::size_t>(3 + c)] == (c == driven ? 0.0 : wanted[c]));
  }
}
