// Rows over several bodies in random poses: gradients and second rates against differences, whatever their bodies are merged
// into, driven by or held by, and the rows that are counted.
#include "mbd/dynamics/linearization.h"
#include "mbd/rest/freedom.h"
#include "mbd/rest/statics.h"
#include "mbd/system/one_sided_row.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string body_at(const std::string& name, double x, double y) {
  return body(name, "mass = 1.5; inertia = 0.3; position = [" + std::to_string(x) + ", " + std::to_string(y) + "]");
}

std::string marker_at(const std::string& name, const std::string& of, double x, double y) {
  return table_text("marker", "name = \"" + name + "\"\n",
                    "body = \"" + of + "\"; point = [" + std::to_string(x) + ", " + std::to_string(y) + "]");
}

// From a hook over a block that is welded to a lump (twice, with a part within it), the ground, a driven block and a link on a
// pin, to a weight. Every point is off its body's centre.
const std::string k_scene =
    body_at("hook", -1.0, -1.0) + body_at("block", -0.5, 0.3) + body_at("lump", -0.1, 0.8) + body_at("driven", 0.7, 0.4) +
    body_at("link", 1.2, 0.1) + body_at("weight", 1.5, -1.2) + marker_at("p0", "hook", 0.1, 0.2) + marker_at("p1", "block", -0.2, 0.1) +
    marker_at("p2", "lump", 0.3, -0.1) + marker_at("p3", "ground", 0.2, 0.1) + marker_at("p4", "driven", -0.1, 0.25) +
    marker_at("p5", "driven", 0.15, 0.2) + marker_at("p6", "link", 0.2, -0.1) + marker_at("p7", "weight", -0.1, 0.3) +
    element("weld", "bolt", "a = \"lump\"; b = \"block\"") +
    element("revolute", "pin", "a = { body = \"link\", at = [1.0, 0.4] }; b = { body = \"hook\", at = [1.0, 0.4] }") +
    element("prescribed_motion", "drive", "a = \"driven\"; coordinate = \"x\"; signal = \"wave\"; as = \"velocity\"") +
    signal_entry("harmonics", "wave", "amplitudes = [0.5]; frequencies = [0.8]") +
    element("rope", "rope", "a = \"p0\"; b = \"p7\"; over = [\"p1\", \"p2\", \"p3\", \"p4\", \"p5\", \"p6\"]; inextensible = true") +
    "[simulation]\nstep = 1e-3\n";

struct Bench {
  std::unique_ptr<System> system = compile(scene(k_scene));
  State state = system->initial_state();
  Dynamics dynamics{*system};
  const OneSidedRow* rope = system->frictions[0].rope;
  std::vector<double> y, dy;
  int n = 0, row = -1;

  explicit Bench(unsigned seed, bool is_any_pose = true) {
    state.friction[0].phase = FrictionPhase::stick;
    dynamics.set_state(state);
    dynamics.set_left_limit_time(9.0);
    n = dynamics.coordinate_count();
    y.resize(dynamics.dimension());
    dy.resize(y.size());
    dynamics.pack(state, y.data());
    std::mt19937 generator(seed);
    const auto random = [&generator] { return static_cast<double>(generator()) / 2147483648.0 - 1.0; };
    for (int i = 0; i < n; ++i) {
      if (is_any_pose) y[i] += 0.3 * random();
      y[n + i] = 2.0 * random();
    }
    for (std::size_t r = 0; r < dynamics.layout().active.size(); ++r)
      if (dynamics.layout().active[r].friction == 0) row = static_cast<int>(r);
  }
  MeasureValue<double> measured(double t, const std::vector<double>& at) {
    dynamics.rates(t, at.data(), dy.data());
    return rope->measured(dynamics.motion().data());
  }
};

} // namespace

TEST_CASE("gradients of a rope over many bodies are those of differences") {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    Bench b(seed);
    REQUIRE(b.row >= 0);
    CHECK(b.dynamics.layout().has_long_rows());
    Linearization linear;
    linear.evaluate(b.dynamics, 0.3, b.y.data());
    const MatX j = linear.dense(linear.gradient(), linear.rows());
    for (int c = 0; c < b.n; ++c) {
      if (b.dynamics.layout().inverse_mass[c] == 0.0) continue; // driven: it does not follow y
      constexpr double k_step = 1e-5;                           // leaves its square, 1e-10, times third derivatives near 1
      std::vector<double> ahead = b.y, behind = b.y;
      ahead[c] += k_step;
      behind[c] -= k_step;
      const double slope = (b.measured(0.3, ahead).value - b.measured(0.3, behind).value) / (2.0 * k_step);
      CHECK(std::abs(j(b.row, c) - slope) < 1e-8);
    }
  }
}

// Along the motion that the accelerations give the rate of the length does not change: J a is minus the second rate at zero
// accelerations, of bodies that ride on others and of one that is driven too.
TEST_CASE("accelerations keep the rate of a rope's length") {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    Bench b(seed);
    (void)b.measured(0.3, b.y);
    const std::vector<double> slope = b.dy;
    constexpr double k_step = 2e-6; // its square times third rates near 1e3, and rounding of 1e-15 over it
    std::vector<double> ahead = b.y, behind = b.y;
    for (int i = 0; i < 2 * b.n; ++i) {
      ahead[i] += k_step * slope[i];
      behind[i] -= k_step * slope[i];
    }
    const double change = (b.measured(0.3 + k_step, ahead).rate - b.measured(0.3 - k_step, behind).rate) / (2.0 * k_step);
    CHECK(std::abs(change) < 1e-7);
    CHECK(std::abs(b.dynamics.multipliers()[b.row]) > 1e-3); // it takes a force
  }
}

TEST_CASE("linearisation with a rope over many bodies against differences of the rates") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Bench b(seed);
    Linearization linear;
    linear.evaluate(b.dynamics, 0.3, b.y.data());
    MatX exact[2];
    linear.acceleration_by_state(exact[0], exact[1]);
    for (int kind = 0; kind < 2; ++kind) {
      MatX difference = MatX::Zero(b.n, b.n);
      for (int c = 0; c < b.n; ++c) {
        const auto slope = [&](double h) {
          std::vector<double> moved = b.y, ahead(b.y.size()), behind(b.y.size());
          moved[kind * b.n + c] += h;
          b.dynamics.rates(0.3, moved.data(), ahead.data());
          moved[kind * b.n + c] -= 2.0 * h;
          b.dynamics.rates(0.3, moved.data(), behind.data());
          return VecX((VecX::Map(ahead.data() + b.n, b.n) - VecX::Map(behind.data() + b.n, b.n)) / (2.0 * h));
        };
        difference.col(c) = (4.0 * slope(2e-5) - slope(4e-5)) / 3.0;
      }
      // Two steps and Richardson's extrapolation: about 1e-9 of the largest entry (test_linearization.cpp).
      const double size = std::max(1.0, difference.cwiseAbs().maxCoeff());
      CHECK((exact[kind] - difference).cwiseAbs().maxCoeff() / size < 3e-8);
    }
  }
}

// In the bodies' own coordinates, as rest is searched for.
TEST_CASE("statics knows a rope's gradient and curvature") {
  Bench b(1, false);
  Statics statics(*b.system);
  State& state = b.state;
  std::mt19937 generator(7);
  for (std::size_t i = 3; i < state.q.size(); ++i) state.q[i] += 0.2 * (static_cast<double>(generator()) / 2147483648.0 - 1.0);
  statics.evaluate(state);
  statics.collect_rows(state);
  const MatX j = statics.gradient();
  const auto row = static_cast<Eigen::Index>(statics.rows().size()) - 1;
  VecX lambda = VecX::Zero(row + 1);
  const MatX without = statics.stiffness(lambda);
  lambda[row] = 1.0;
  const MatX curvature = statics.stiffness(lambda) - without;
  constexpr double k_step = 1e-5;
  for (int c = 0; c < statics.coordinates(); ++c) {
    State moved = state;
    moved.q[3 + c] += k_step;
    statics.evaluate(moved);
    const double ahead = statics.off()[row];
    const MatX j_ahead = statics.gradient();
    moved.q[3 + c] -= 2.0 * k_step;
    statics.evaluate(moved);
    CHECK(std::abs(j(row, c) - (ahead - statics.off()[row]) / (2.0 * k_step)) < 1e-8);
    CHECK((curvature.col(c) - (j_ahead - statics.gradient()).row(row).transpose() / (2.0 * k_step)).cwiseAbs().maxCoeff() < 1e-7);
  }
}

// 18 coordinates; weld 3, pin 2, drive 1, and the rope's one row while it is taut.
TEST_CASE("a rope over many bodies is one row") {
  Bench b(1);
  const DegreesOfFreedom freedom = count_freedom(*b.system);
  CHECK(freedom.degrees() == 12);
  CHECK(freedom.degrees_sticking() == 11);
  CHECK(freedom.shared_sticking.empty());
}
