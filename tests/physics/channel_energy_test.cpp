// Channels on request against closed forms and conservation: a marker's acceleration, what joints and motors do, and where
// the energy goes, element by element.
#include "tests/elements/conformance_probe.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using steplap::testing::run;
using steplap::testing::scene;

namespace {

std::vector<double> sum_of(const steplap::testing::Run& r, const std::string& ending) {
  std::vector<double> sum(r.times().size(), 0.0);
  for (const Channel* channel : r.result.trajectory->channels()) {
    if (!channel->name.ends_with(ending) || channel->name.starts_with("whole.")) continue;
    const std::vector<double> series = r.series(channel->name);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += series[i];
  }
  return sum;
}

double largest(const std::vector<double>& a) {
  double most = 0.0;
  for (const double v : a) most = std::max(most, std::abs(v));
  return most;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

constexpr double k_mass = 2.0, k_inertia = 0.3, k_arm = 0.4, k_gravity = 9.81;

const std::string k_pendulum = R"(
[output]
also = ["*"]
[[body]]
name = "rod"
mass = 2.0
inertia = 0.3
position = [0.4, 0.0]
[[marker]]
name = "tip"
body = "rod"
point = [0.5, 0.1]
[[element]]
name = "pin"
kind = "revolute"
a = { body = "rod", at = [0.0, 0.0] }
b = "ground"
)";

} // namespace

TEST_CASE("a pendulum's marker: place, velocity and acceleration by the closed form") {
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(method);
    const auto r = run(k_pendulum, {method, 1e-11, 2.0, 0.01});
    const auto theta = r.series("rod.theta"), omega = r.series("rod.omega");
    const auto x = r.series("tip.x"), vy = r.series("tip.vy"), ax = r.series("tip.ax"), ay = r.series("tip.ay");
    const auto angle = r.series("pin.angle"), rate = r.series("pin.rate"), reaction = r.series("pin.reaction");
    const auto fx = r.series("pin.force_x"), fy = r.series("pin.force_y");
    const double about_pin = k_inertia + k_mass * k_arm * k_arm;
    for (std::size_t i = 0; i < theta.size(); ++i) {
      // θ″ = −m g l cos θ/J; a point at (0.9, 0.1) from the pin in the rod's axes
      const double alpha = -k_mass * k_gravity * k_arm * std::cos(theta[i]) / about_pin;
      const double rx = 0.9 * std::cos(theta[i]) - 0.1 * std::sin(theta[i]), ry = 0.9 * std::sin(theta[i]) + 0.1 * std::cos(theta[i]);
      const double w2 = omega[i] * omega[i];
      // Exact functions of θ and ω: but for rounding and the drift of the pin, which projection keeps below 1e-12 m.
      CHECK(x[i] == doctest::Approx(rx).scale(1.0).epsilon(1e-11));
      CHECK(vy[i] == doctest::Approx(omega[i] * rx).scale(10.0).epsilon(1e-11));
      CHECK(ax[i] == doctest::Approx(-alpha * ry - w2 * rx).scale(50.0).epsilon(1e-10));
      CHECK(ay[i] == doctest::Approx(alpha * rx - w2 * ry).scale(50.0).epsilon(1e-10));
      CHECK(angle[i] == doctest::Approx(theta[i]).scale(1.0).epsilon(1e-15));
      CHECK(rate[i] == doctest::Approx(omega[i]).scale(10.0).epsilon(1e-15));
      CHECK(reaction[i] == doctest::Approx(std::hypot(fx[i], fy[i])).epsilon(1e-15));
    }
    // An ideal joint gives no power: 40 N times the velocity that projection leaves, 1e-11 m/s at most.
    CHECK(largest(r.series("pin.power")) < 1e-8);
    // m g l sin θ gained is lost by the height: the balance stays what it was, to the tolerance of 2 s (300 of 1e-11 of 8 J).
    const auto balance = r.series("whole.balance");
    for (const double b : balance) CHECK(b == doctest::Approx(balance.front()).scale(8.0).epsilon(1e-8));
  }
}

TEST_CASE("the extreme of a marker's acceleration lies between samples") {
  // Lowest, the tip's acceleration is ω² r upwards, ω² = 2 m g l/J: released level, no sample hits that time.
  const std::string text = k_pendulum + "[[marker]]\nname = \"end\"\nbody = \"rod\"\npoint = [0.5, 0.0]\n";
  const Model model = scene(text + "\n[simulation]\nstep = 1e-3\n");
  SimulationOptions options = testing::options({"dop853", 1e-11, 1.0, 0.1});
  options.has_extremes = true;
  const auto system = compile(model);
  const RunResult result = simulate(*system, system->initial_state(), options);
  const double w2 = 2.0 * k_mass * k_gravity * k_arm / (k_inertia + k_mass * k_arm * k_arm);
  int found = 0;
  for (const ChannelRange& range : result.ranges) {
    if (range.channel->name != "end.ay") continue;
    ++found;
    CHECK(range.high.value == doctest::Approx(0.9 * w2).epsilon(3e-6)); // k_resolution of its range, 1e-6
  }
  CHECK(found == 1);
}

TEST_CASE("every kind of element: the shares of energy add up to the whole") {
  int with_loss = 0, with_work = 0, scenes = 0;
  for (const auto& conformance : steplap::testing::conformance_scenes()) {
    CAPTURE(conformance.kind);
    CAPTURE(conformance.text);
    const std::string text = "[output]\nalso = [\"*\"]\n";
    std::string whole = steplap::testing::conformance_text(conformance, false);
    whole.insert(whole.find("[simulation]"), text);
    Model model = parse_model(whole, "scene.toml", transformer_catalog());
    for (Body& body : model.bodies) { // something has to move
      body.velocity = Vec2(body.name == "a" ? 0.4 : -0.2, 0.3);
      body.angular_velocity = body.name == "a" ? -0.7 : 0.5;
    }
    ++scenes;
    testing::Run r;
    try {
      r = run(model, {"dop853", 1e-10, 0.2, 0.01});
    } catch (const NumericalFailure& failure) {
      MESSAGE(conformance.kind << ": " << failure.what());
      continue;
    }
    const auto dissipated = r.series("whole.dissipated"), work = r.series("whole.work"), balance = r.series("whole.balance");
    const auto parts = sum_of(r, ".dissipated"), works = sum_of(r, ".work"), stored = sum_of(r, ".stored");
    // What the motion turns over; both sides are integrals of the same powers to 1e-10 of that per step, some hundred steps. The
    // finest force laws have kinks of higher derivatives inside steps, where no rule is exact: 1e-6 leaves room for these.
    const double scale = std::max({1.0, largest(r.series("whole.kinetic")), largest(dissipated), largest(work)});
    CHECK(largest_difference(parts, dissipated) < 1e-6 * scale);
    CHECK(largest_difference(works, work) < 1e-6 * scale);
    // Without gravity all potential energy is stored in elements.
    CHECK(largest_difference(stored, r.series("whole.potential")) < 1e-9 * std::max(1.0, largest(stored)));
    for (const double b : balance) CHECK(std::abs(b - balance.front()) < 1e-6 * scale);
    with_loss += largest(dissipated) > 1e-3;
    with_work += largest(work) > 1e-3;
  }
  CHECK(scenes > 25);
  CHECK(with_loss > 8); // the test has something to tell
  CHECK(with_work > 3);
}

TEST_CASE("asking for channels changes no bit of the motion") {
  for (const char* file : {"benchmarks/andrews.toml", "paper/no_interference.toml"}) {
    CAPTURE(file);
    Model model = read_model(std::string(STEPLAP_MODELS) + "/" + file, transformer_catalog());
    SimulationOptions options = options_of(model);
    options.end = std::min(options.end, 0.12);
    options.has_extremes = false;
    const auto usual = compile(model);
    const RunResult plain = simulate(*usual, usual->initial_state(), options);
    model.output.also = {"*"};
    const auto asked = compile(model);
    REQUIRE(!asked->integrands.empty());
    const RunResult full = simulate(*asked, asked->initial_state(), options);
    CHECK(plain.final_state.q == full.final_state.q);
    CHECK(plain.final_state.v == full.final_state.v);
    CHECK(plain.final_state.dissipated == full.final_state.dissipated);
    CHECK(plain.events.size() == full.events.size());
  }
}

TEST_CASE("friction's heat is force times way") {
  // A block of 3 kg slides from 2 m/s against μ = 0.3 under its weight until it rests: all of ½ m v², 6 J, in one element.
  const auto r = run(R"(
[output]
also = ["*.dissipated", "whole.*"]
[[body]]
name = "block"
mass = 3.0
inertia = 0.5
velocity = [2.0, 0.0]
[[element]]
name = "guide"
kind = "prismatic"
a = "block"
b = "ground"
[[element]]
name = "brake"
kind = "joint_friction"
a = "block"
b = "ground"
coordinate = "x"
holds = 8.829
)",
                     {"dop853", 1e-11, 1.0, 0.01});
  CHECK(r.last("brake.dissipated") == doctest::Approx(6.0).epsilon(1e-10));
  const double rest = 2.0 / (8.829 / 3.0);
  const auto heat = r.series("brake.dissipated"), x = r.series("block.x");
  for (std::size_t i = 0; i < heat.size(); ++i) CHECK(heat[i] == doctest::Approx(8.829 * x[i]).scale(6.0).epsilon(1e-10));
  CHECK(rest < 1.0);
}

TEST_CASE("a motor's power is what the energy grows by, and what a tie stored is gone when it breaks") {
  const auto motor = run(R"(
gravity = [0.0, 0.0]
[output]
also = ["*"]
[[body]]
name = "wheel"
mass = 1.0
inertia = 0.2
[[element]]
name = "axle"
kind = "revolute"
a = "wheel"
b = "ground"
[[element]]
name = "drive"
kind = "motor"
a = "wheel"
b = "ground"
constant_effort = 3.0
no_load_speed = 10.0
)",
                         {"dop853", 1e-12, 1.5, 0.01});
  const auto kinetic = motor.series("whole.kinetic"), work = motor.series("drive.work"), power = motor.series("drive.power");
  const auto t = motor.times();
  for (std::size_t i = 0; i < t.size(); ++i) {
    // ω = 10 (1 − e^(−1.5 t)): M = 3 (1 − ω/10), J ω' = M
    const double omega = 10.0 * (1.0 - std::exp(-1.5 * t[i])), effort = 3.0 * (1.0 - 0.1 * omega);
    CHECK(kinetic[i] == doctest::Approx(0.1 * omega * omega).scale(10.0).epsilon(1e-10));
    CHECK(work[i] == doctest::Approx(kinetic[i]).scale(10.0).epsilon(1e-10));
    CHECK(power[i] == doctest::Approx(omega * effort).scale(10.0).epsilon(1e-10));
    CHECK(motor.series("drive.rate")[i] == doctest::Approx(omega).scale(10.0).epsilon(1e-10));
  }

  const auto tie = run(R"(
gravity = [0.0, 0.0]
[output]
also = ["*"]
[[body]]
name = "mass"
mass = 1.0
inertia = 0.2
position = [1.0, 0.0]
velocity = [3.0, 0.0]
[[element]]
name = "bolt"
kind = "tie"
a = "mass"
b = "ground"
stiffness = 1000.0
strength = 60.0
)",
                       {"dop853", 1e-12, 0.2, 0.001});
  // It breaks at δ = 60 N/(1000 N/m): ½ k δ² = 1.8 J of the 4.5 J, at once.
  CHECK(tie.last("bolt.dissipated") == doctest::Approx(1.8).epsilon(1e-9));
  CHECK(tie.last("whole.dissipated") == doctest::Approx(1.8).epsilon(1e-9));
  CHECK(tie.last("bolt.stored") == 0.0);
  CHECK(tie.last("whole.kinetic") == doctest::Approx(2.7).epsilon(1e-9));
  CHECK(tie.series("bolt.dissipated").front() == 0.0);
}

TEST_CASE("a prescribed motion's work is its force times the way, and methods without error control keep the account, too") {
  const std::string text = R"(
[output]
also = ["*"]
[[body]]
name = "load"
mass = 5.0
inertia = 1.0
[[element]]
name = "rail"
kind = "prismatic"
a = "load"
b = "ground"
axis = [0.0, 1.0]
[[signal]]
name = "lift"
kind = "constant"
value = 2.0
[[element]]
name = "hoist"
kind = "prescribed_motion"
a = "load"
coordinate = "y"
signal = "lift"
[[element]]
name = "damper"
kind = "spring_damper"
a = "load"
b = { body = "ground", at = [0.0, -1.0] }
damping = 7.0
)";
  // y = t²: F = m (g + 2) + 7 · 2t, work ∫ F 2t dt = 5 · 11.81 t² + 28/3 t³; the damper takes 28/3 t³.
  for (const auto& [method, step, bound] :
       {std::tuple{"dop853", 1e-11, 1e-9}, {"rk4", 1e-3, 1e-9}, {"rodas5p", 1e-10, 1e-8}, {"moreau", 1e-3, 1e-2}}) {
    CAPTURE(method);
    Model model = scene(text + "\n[simulation]\nstep = 1e-3\n");
    SimulationOptions options = testing::options({method, step, 1.0, 0.05});
    options.settings.step = 1e-3;
    const auto system = compile(model);
    const RunResult result = simulate(*system, system->initial_state(), options);
    const auto& times = result.trajectory->times();
    const auto work = result.trajectory->series("hoist.work"), heat = result.trajectory->series("damper.dissipated");
    const auto power = result.trajectory->series("hoist.power");
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double t = times[i];
      CHECK(std::abs(work[i] - (59.05 * t * t + 28.0 / 3.0 * t * t * t)) < bound * 68.0); // moreau: of the first order, 1e-3 of 10 powers
      CHECK(std::abs(heat[i] - 28.0 / 3.0 * t * t * t) < bound * 68.0);
      CHECK(std::abs(power[i] - 2.0 * t * (59.05 + 14.0 * t)) < 2.0 * bound * 150.0);
    }
  }
}

TEST_CASE("an elastic step-lap joint: what yielding takes and what its spring holds") {
  // The block of step_lap_elastic_test.cpp: strain up to F₀/K, then it slides with F₀ = 400 N until it stops.
  const double m = 10.0, k = 1e6, v = 0.5, bound = 400.0;
  const double v1_squared = v * v - bound * bound / (m * k), slid = 0.5 * m * v1_squared / bound;
  const double w = std::sqrt(k / m), stop = std::asin(bound / k * w / v) / w + m * std::sqrt(v1_squared) / bound;
  const std::string text = R"(
gravity = [0.0, 0.0]
[output]
also = ["*"]
[[body]]
name = "limb"
mass = 10.0
inertia = 1.0
velocity = [0.5, 0.0]
[[element]]
name = "joint"
kind = "step_lap_joint"
limb = "limb"
active_part = "ground"
tangential_stiffness = 1e6
[[element]]
name = "sheets"
kind = "step_lap_interface"
joint = "joint"
yoke = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
limb = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]
pressure = 1e5
static_friction = 0.2
)";
  const auto r = run(text, {"dop853", 1e-11, stop, stop / 16.0});
  // Of 1.25 J the spring holds ½ F₀²/K, the rest is heat; the bounds are those of that test's slid distance.
  CHECK(r.last("joint.dissipated") == doctest::Approx(bound * slid).epsilon(1e-9));
  CHECK(r.last("joint.stored") == doctest::Approx(0.5 * bound * bound / k).epsilon(1e-9));
  CHECK(largest_difference(r.series("joint.dissipated"), r.series("whole.dissipated")) < 1e-9);
}

TEST_CASE("models with friction, contacts and joints that part: shares add up through all events") {
  for (const char* file :
       {"benchmarks/stick_slip_belt.toml", "benchmarks/den_hartog.toml", "layouts/joint_apart.toml", "paper/weak_clamping.toml"}) {
    CAPTURE(file);
    Model model = read_model(std::string(STEPLAP_MODELS) + "/" + file, transformer_catalog());
    model.output.also = {"*"};
    testing::Run r;
    r.system = compile(model);
    SimulationOptions options = options_of(model);
    options.channels.clear();
    options.has_extremes = false;
    options.end = std::min(options.end, 0.3);
    r.result = simulate(*r.system, r.system->initial_state(), options);
    const auto dissipated = r.series("whole.dissipated"), work = r.series("whole.work");
    const double scale = std::max(largest(dissipated), largest(work));
    REQUIRE(scale > 0.0);
    // Two quadratures of the same powers; each model's own tolerance or step knows them to some 1e-9.
    CHECK(largest_difference(sum_of(r, ".dissipated"), dissipated) < 1e-7 * scale);
    CHECK(largest_difference(sum_of(r, ".work"), work) < 1e-7 * scale);
  }
}
