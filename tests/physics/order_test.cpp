// Orders of convergence on a smooth constrained problem, steps held equal: a double pendulum of a pinned
// body and a rod, with a driven pivot, springs and dampers.
#include "mbd/integrators/integrator.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

const char* k_scene = R"(
[[signal]]
name = "shake"
kind = "harmonics"
amplitudes = [0.5]
frequencies = [0.8]
[[body]]
name = "upper"
mass = 2.0
inertia = 0.3
position = [0.5, 0.0]
[[body]]
name = "lower"
mass = 1.0
inertia = 0.1
position = [1.0, -0.8]
velocity = [0.0, 0.0]
[[element]]
kind = "prescribed_motion"
name = "pivot x"
a = { body = "upper", at = [0.0, 0.0] }
coordinate = "x"
signal = "shake"
as = "velocity"
[[signal]]
name = "still"
kind = "constant"
value = 0.0
[[element]]
kind = "prescribed_motion"
name = "pivot y"
a = { body = "upper", at = [0.0, 0.0] }
coordinate = "y"
signal = "still"
as = "velocity"
[[element]]
kind = "distance"
name = "rod"
a = "lower"
b = { body = "upper", at = [1.0, 0.0] }
[[element]]
kind = "spring_damper"
name = "spring"
a = "lower"
stiffness = 20.0
damping = 0.8
)";

// A tolerance that nothing exceeds and a largest step: an adaptive method with equal steps.
SimulationOptions with_step(const std::string& integrator, double h, double end) {
  SimulationOptions o;
  o.end = end;
  o.integrator = integrator;
  o.settings.step = o.settings.max_step = h;
  o.settings.tolerance = 1e30;
  o.settings.projection_tolerance = 1e-14;
  return o;
}

State final_state(const System& system, const SimulationOptions& options) {
  return simulate(system, system.initial_state(), options).final_state;
}

double distance(const State& a, const State& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) sum += std::pow(a.q[i] - b.q[i], 2) + std::pow(a.v[i] - b.v[i], 2);
  return std::sqrt(sum);
}

} // namespace

TEST_CASE("rk4, tsit5, dop853, rodas5p and moreau converge with orders 4, 5, 8, 5 and 1 on a constrained problem") {
  const auto system = compile(scene(std::string(k_scene) + "[simulation]\nstep = 1e-3\n"));
  struct Case {
    const char* integrator;
    double order, end;
    int coarse; ///< steps a second: so many that the leading error term rules, so few that rounding does not
    double tolerance;
  };
  // dop853's leading coefficients are so small that its order shows only over one halving above rounding: 8.19, of which the
  // next term makes some 12 over the steps a second (8.31 at 48, 8.26 at 56), and rounding 0.04.
  for (const Case& c : {Case{"rk4", 4.0, 1.0, 256, 0.1}, Case{"tsit5", 5.0, 1.0, 256, 0.1}, Case{"dop853", 8.0, 0.5, 64, 0.2},
                        Case{"rodas5p", 5.0, 1.0, 128, 0.2}, Case{"moreau", 1.0, 1.0, 256, 0.1}}) {
    const State exact = final_state(*system, with_step("dop853", 1.0 / 512, c.end));
    const double coarse = distance(final_state(*system, with_step(c.integrator, 1.0 / c.coarse, c.end)), exact);
    const double fine = distance(final_state(*system, with_step(c.integrator, 0.5 / c.coarse, c.end)), exact);
    CAPTURE(std::string(c.integrator));
    CAPTURE(fine);
    CHECK(fine > 1e-13); // rounding is 1e-14
    CHECK(std::abs(std::log2(coarse / fine) - c.order) < c.tolerance);
  }
}

TEST_CASE("dense output: one step's error inside it falls with the order it claims") {
  const auto system = compile(scene(std::string(k_scene) + "[simulation]\nstep = 1e-3\n"));
  struct Case {
    const char* integrator;
    double position, velocity; ///< orders of the local error
    double h;
  };
  // rk4: h⁵ is its own local error; in the velocities the quintic's slope divides it by h, which is still the
  // order of the method. tsit5: dense output of order 4; dop853: of order 7; rodas5p: of order 4.
  for (const Case& c :
       {Case{"rk4", 5.0, 4.0, 0.05}, Case{"tsit5", 5.0, 5.0, 0.05}, Case{"dop853", 8.0, 8.0, 0.1}, Case{"rodas5p", 5.0, 5.0, 0.05}}) {
    CAPTURE(std::string(c.integrator));
    double error[2][2] = {};
    for (int i = 0; i < 2; ++i) {
      const double h = c.h / (1 << i);
      // The simulation brings the state onto the constraints; from there one step by hand.
      Simulation start(*system, system->initial_state(), with_step("rk4", 1e-3, 1.0));
      const State initial = start.state();
      Dynamics dynamics(*system);
      dynamics.set_state(initial);
      dynamics.set_left_limit_time(1.0);
      std::vector<double> y(dynamics.dimension()), out(y), z(y);
      dynamics.pack(initial, y.data());
      const auto step = [&](const char* name, double size, int count, double theta, std::vector<double>& result) {
        const auto integrator = make_integrator(name, dynamics, with_step(name, size, 1.0).settings);
        integrator->restart(dynamics, 0.0, y.data());
        for (int k = 0; k < count; ++k) {
          integrator->step(dynamics, 1.0);
          if (k + 1 < count) integrator->accept();
        }
        integrator->dense(dynamics, theta, result.data());
      };
      const int n = dynamics.coordinate_count();
      for (const double theta : {0.25, 0.375, 0.75}) {
        step(c.integrator, h, 1, theta, out);
        step("dop853", theta * h / 8, 8, 1.0, z);
        for (int k = 0; k < n; ++k) {
          error[0][i] = std::max(error[0][i], std::abs(out[k] - z[k]));
          error[1][i] = std::max(error[1][i], std::abs(out[n + k] - z[n + k]));
        }
      }
    }
    CAPTURE(error[0][0]);
    CAPTURE(error[0][1]);
    CHECK(std::log2(error[0][0] / error[0][1]) > c.position - 0.4);
    CHECK(std::log2(error[1][0] / error[1][1]) > c.velocity - 0.4);
  }
}
