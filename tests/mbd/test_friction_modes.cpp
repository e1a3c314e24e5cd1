// The mode problem against brute force: stacks of blocks, every combination of stick and slip in both
// directions tried, the one that is consistent is what the kernel must find.
#include "mbd/events/friction_modes.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <cmath>
#include <cstdio>
#include <random>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// Blocks that lie on one another (is_stack) or each on the ground, pulled by forces; neighbours may be
// coupled by rods. Friction element i acts between block i and what it lies on.
struct Blocks {
  std::vector<double> mass, mu, force;
  bool is_stack = false, is_chained = false;
  double rear_share = 0.0; ///< if not zero, each block stands on two feet that stick for themselves
  [[nodiscard]] std::size_t count() const { return mass.size(); }
  [[nodiscard]] double normal(std::size_t i) const {
    double sum = 0.0;
    for (std::size_t k = i; k < (is_stack ? count() : i + 1); ++k) sum += mass[k] * 9.81;
    return sum;
  }
};

std::string text_of(const Blocks& b) {
  std::string text = "[simulation]\nstep = 1e-4\n[[signal]]\nname = \"still\"\nkind = \"constant\"\nvalue = 0.0\n";
  for (std::size_t i = 0; i < b.count(); ++i) {
    const std::string n = std::to_string(i), name = "\"block " + n + "\"", below = "\"block " + std::to_string(i - 1) + "\"";
    const double x = b.is_stack ? 0.0 : 2.0 * static_cast<double>(i), y = b.is_stack ? static_cast<double>(i) : 0.0;
    text += "[[body]]\nname = " + name + "\nmass = " + number(b.mass[i]) + "\ninertia = 1.0\nposition = [" + number(x) + ", " + number(y) +
            "]\n";
    text += "[[element]]\nkind = \"prescribed_motion\"\nname = \"upright " + n + "\"\na = " + name +
            "\ncoordinate = \"angle\"\nsignal = \"still\"\n";
    const std::string on = b.is_stack && i > 0 ? "{ body = " + below + ", point = [0.0, 0.5] }" : "{ body = \"ground\", at = [0.0, -0.5] }";
    const int feet = b.rear_share > 0.0 ? 2 : 1;
    for (int foot = 0; foot < feet; ++foot) {
      // Halves of the weight, shares of the friction.
      const double share = feet == 1 ? 1.0 : 2.0 * (foot == 0 ? b.rear_share : 1.0 - b.rear_share);
      const std::string of = foot == 0 ? n : n + "b", at = feet == 1 ? "0.0" : foot == 0 ? "-0.3" : "0.3";
      text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"sole " + of + "\"\na = { body = " + name + ", point = [" + at +
              ", -0.5] }\nb = " + on + "\nstiffness = 1e5\ndamping = 300.0\npreload = " + number(b.normal(i) / feet) + "\n";
      text += "[[element]]\nkind = \"coulomb_stick\"\nname = \"friction " + of + "\"\ncontacts = [\"sole " + of +
              "\"]\nstatic_friction = " + number(share * b.mu[i]) + "\n";
    }
    text += "[[element]]\nkind = \"load\"\nname = \"pull " + n + "\"\nat = " + name + "\nforce = [" + number(b.force[i]) + ", 0.0]\n";
    if (b.is_chained && i > 0) text += "[[element]]\nkind = \"distance\"\nname = \"rod " + n + "\"\na = " + name + "\nb = " + below + "\n";
  }
  return text;
}

struct Answer {
  std::vector<int> mode; ///< 0 stick, ±1 slip
  std::vector<double> acceleration;
};

// One combination: unknowns are accelerations, friction forces and rod forces; equations are Newton's, the
// mode's, and the rods'. True if it is consistent.
bool try_modes(const Blocks& b, const std::vector<int>& mode, Answer& answer) {
  const int n = static_cast<int>(b.count()), rods = b.is_chained ? n - 1 : 0, size = 2 * n + rods;
  MatX a = MatX::Zero(size, size);
  VecX right = VecX::Zero(size);
  for (int i = 0; i < n; ++i) {
    a(i, i) = b.mass[i];
    a(i, n + i) = -1.0;
    if (b.is_stack && i + 1 < n) a(i, n + i + 1) = 1.0;
    right[i] = b.force[i];
    if (mode[i] == 0) {
      a(n + i, i) = 1.0;
      if (b.is_stack && i > 0) a(n + i, i - 1) = -1.0;
    } else {
      a(n + i, n + i) = 1.0;
      right[n + i] = -mode[i] * b.mu[i] * b.normal(i);
    }
  }
  for (int r = 0; r < rods; ++r) {
    a(r, 2 * n + r) = 1.0;
    a(r + 1, 2 * n + r) = -1.0;
    a(2 * n + r, r) = 1.0;
    a(2 * n + r, r + 1) = -1.0;
  }
  const Eigen::FullPivLU<MatX> lu(a);
  if (!lu.isInvertible()) return false;
  const VecX x = lu.solve(right);
  for (int i = 0; i < n; ++i) {
    const double relative = x[i] - (b.is_stack && i > 0 ? x[i - 1] : 0.0);
    if (mode[i] == 0 && std::abs(x[n + i]) > b.mu[i] * b.normal(i)) return false;
    if (mode[i] != 0 && mode[i] * relative <= 0.0) return false;
  }
  answer.mode = mode;
  answer.acceleration.assign(x.data(), x.data() + n);
  return true;
}

// All consistent combinations; there is one, as the problem is strictly convex.
std::vector<Answer> brute_force(const Blocks& b) {
  std::vector<Answer> found;
  std::vector<int> mode(b.count(), -1);
  for (;;) {
    Answer answer;
    if (try_modes(b, mode, answer)) found.push_back(answer);
    std::size_t i = 0;
    while (i < mode.size() && mode[i] == 1) mode[i++] = -1;
    if (i == mode.size()) return found;
    ++mode[i];
  }
}

Blocks random_blocks(std::size_t count, bool is_stack, std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Blocks b;
  b.is_stack = is_stack;
  for (std::size_t i = 0; i < count; ++i) {
    b.mass.push_back(0.5 + 3.0 * unit(generator));
    b.mu.push_back(0.1 + 0.6 * unit(generator));
  }
  for (std::size_t i = 0; i < count; ++i) b.force.push_back((2.0 * unit(generator) - 1.0) * 1.5 * b.mu[i] * b.normal(i));
  return b;
}

void check_against(const Blocks& b, const Answer& expected) {
  const auto system = compile(scene(text_of(b)));
  const Simulation simulation(*system, system->initial_state(), options({"rk4", 1e-4, 1e-3}));
  const State& state = simulation.state();
  const std::size_t feet = b.rear_share > 0.0 ? 2 : 1;
  for (std::size_t i = 0; i < feet * b.count(); ++i) {
    const FrictionState& f = state.friction[i];
    CHECK((f.phase == FrictionPhase::slip ? f.sign : 0) == expected.mode[i / feet]);
  }
  // And it goes on so: nothing changes its mind, and the accelerations are those found.
  const Run r = run(scene(text_of(b)), {"rk4", 1e-4, 1e-3});
  for (const Event& event : r.result.events) CHECK(event.is_at_start()); // what slips does so from there
  for (std::size_t i = 0; i < b.count(); ++i)
    CHECK(std::abs(r.last("block " + std::to_string(i) + ".ax") - expected.acceleration[i]) <
          1e-9 * (1.0 + std::abs(expected.acceleration[i])));
}

} // namespace

TEST_CASE("friction modes: stacks of two to five blocks against every combination") {
  std::mt19937 generator(11);
  int slipping = 0, sticking = 0;
  for (const std::size_t count : {1, 2, 3, 4, 5})
    for (int draw = 0; draw < 15; ++draw) {
      const Blocks b = random_blocks(count, true, generator);
      const std::vector<Answer> answers = brute_force(b);
      REQUIRE(answers.size() == 1);
      check_against(b, answers[0]);
      for (const int mode : answers[0].mode) ++(mode == 0 ? sticking : slipping);
    }
  CHECK(slipping > 40);
  CHECK(sticking > 40);
}

TEST_CASE("friction modes: stacks on two feet each, which share their loads, against every combination") {
  std::mt19937 generator(13);
  for (const std::size_t count : {1, 2, 3, 4})
    for (int draw = 0; draw < 12; ++draw) {
      Blocks b = random_blocks(count, true, generator);
      const std::vector<Answer> answers = brute_force(b);
      REQUIRE(answers.size() == 1);
      b.rear_share = 0.2 + 0.05 * draw;
      check_against(b, answers[0]);
    }
}

TEST_CASE("friction modes: ten blocks on the ground at once") {
  std::mt19937 generator(12);
  for (int draw = 0; draw < 10; ++draw) {
    const Blocks b = random_blocks(10, false, generator);
    Answer expected; // each by itself: no need to try 3^10 combinations
    for (std::size_t i = 0; i < 10; ++i) {
      const double bound = b.mu[i] * b.normal(i);
      const int mode = std::abs(b.force[i]) <= bound ? 0 : (b.force[i] > 0.0 ? 1 : -1);
      expected.mode.push_back(mode);
      expected.acceleration.push_back(mode == 0 ? 0.0 : (b.force[i] - mode * bound) / b.mass[i]);
    }
    check_against(b, expected);
  }
}

TEST_CASE("friction modes: a stack of ten in which one interface gives way") {
  Blocks b;
  b.is_stack = true;
  b.mass.assign(10, 1.0);
  b.mu.assign(10, 0.5);
  b.force.assign(10, 0.0);
  b.force[9] = 4.0; // less than 0.5 m g on the top block: everything holds
  Answer all{std::vector<int>(10, 0), std::vector<double>(10, 0.0)};
  check_against(b, all);
  b.mu[4] = 0.01; // what lies on interface 4 moves as one
  Answer upper = all;
  upper.mode[4] = 1;
  for (std::size_t i = 4; i < 10; ++i) upper.acceleration[i] = (4.0 - 0.01 * 6.0 * 9.81) / 6.0;
  check_against(b, upper);
}

TEST_CASE("friction modes: a chain of blocks joined by rods moves as one") {
  // The wrenches of the single blocks are not unique while all stick; the motion is.
  for (const double pull : {0.9, 1.1}) {
    Blocks b;
    b.is_chained = true;
    b.mass = {1.0, 2.0, 0.5, 3.0};
    b.mu = {0.3, 0.5, 0.2, 0.4};
    b.force = {0.0, 0.0, 0.0, 0.0};
    double bound = 0.0, mass = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      bound += b.mu[i] * b.normal(i);
      mass += b.mass[i];
    }
    b.force[3] = pull * bound;
    const Run r = run(scene(text_of(b)), {"rk4", 1e-4, 0.01});
    const double expected = pull < 1.0 ? 0.0 : (pull - 1.0) * bound / mass;
    for (int i = 0; i < 4; ++i) CHECK(std::abs(r.last("block " + std::to_string(i) + ".ax") - expected) < 1e-9);
    CHECK(r.result.statistics.energy_residual < 1e-10);
  }
}

TEST_CASE("friction modes: static and kinetic coefficients") {
  // Between μ_k N and μ_s N what rests holds and what slides goes on.
  Model model = scene(text_of({{1.0}, {0.5}, {4.0}, false, false}));
  model = parse_model(text_of({{1.0}, {0.5}, {4.0}, false, false}), "scene.toml", transformer_catalog(),
                      {"element.friction 0.kinetic_friction=0.2"});
  const Run rest = run(model, {"rk4", 1e-4, 0.1});
  CHECK(rest.last("block 0.ax") == doctest::Approx(0.0));
  model.bodies[0].velocity = {0.5, 0.0};
  const Run sliding = run(model, {"rk4", 1e-4, 0.1});
  CHECK(sliding.last("block 0.ax") == doctest::Approx(4.0 - 0.2 * 9.81).epsilon(1e-9));
  REQUIRE(sliding.result.events.size() == 1);
  CHECK(sliding.result.events.front().is_at_start());
}

TEST_CASE("friction modes: two feet of one body that stick each for itself slip together at their common bound") {
  // Their rows depend on each other: how they share the load is nobody's to know, when both give way is.
  const std::string text = R"(
[simulation]
step = 1e-3
[[signal]]
name = "ramp"
kind = "triangle"
peak = 12.0
duration = 2.0
[[body]]
name = "box"
mass = 2.0
inertia = 1.0
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "box", at = [-1.0, 0.0] }
stiffness = 1e5
damping = 400.0
preload = 9.81
[[element]]
kind = "unilateral_contact"
name = "front"
a = { body = "box", at = [1.0, 0.0] }
stiffness = 1e5
damping = 400.0
preload = 9.81
[[element]]
kind = "coulomb_stick"
name = "rear friction"
contacts = ["rear"]
static_friction = 0.3
[[element]]
kind = "coulomb_stick"
name = "front friction"
contacts = ["front"]
static_friction = 0.5
[[element]]
kind = "load"
name = "push"
at = "box"
force_x = "ramp"
)";
  // 12 N/s up to 12 N at 1 s and down again; together they hold 0.8 · 9.81 = 7.848 N, which the load passes
  // at t1 = 0.654 s and 2 − t1. Its momentum 12 (1 − t1)² is spent √2 (1 − t1) after that.
  const double onset = 7.848 / 12.0, end = 2.0 - onset + std::sqrt(2.0) * (1.0 - onset);
  for (const Settings& settings : {Settings{"rk4", 1e-3, 2.5, 0.01}, Settings{"dop853", 1e-11, 2.5, 0.01}}) {
    CAPTURE(settings.integrator);
    const Run r = run(scene(text), settings);
    for (std::size_t i = 0; i < r.times().size(); ++i)
      if (r.times()[i] < onset || r.times()[i] > end) CHECK(std::abs(r.series("box.vx")[i]) < 1e-11);
    CHECK(std::abs(r.event_times("front friction", "slips forward").at(0) - onset) < 1e-9);
    CHECK(std::abs(r.event_times("front friction", "sticks").at(0) - end) < 1e-9);
    CHECK(std::abs(r.event_times("rear friction", "sticks").at(0) - end) < 1e-9);
    CHECK(std::abs(r.event_times("rear friction", "slips forward").at(0) - onset) < 1e-9);
    CHECK(r.result.events.size() == 4);
    CHECK(r.result.statistics.energy_residual < 1e-9);
  }
}
