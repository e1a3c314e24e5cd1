// models/machines/shunted_wagons.toml against an integration of its own: three masses on a line, steps of 2 µs, the sign of the rate
// of each buffer telling which curve it follows. It knows no sticking: a buffer at rest changes its curve from step to step.
#include "tests/machines/machine.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

using Curve = std::vector<std::array<double, 2>>;

double at(const Curve& curve, double depth) {
  std::size_t i = 1;
  while (i + 1 < curve.size() && depth > curve[i][0]) ++i;
  return curve[i - 1][1] + (curve[i][1] - curve[i - 1][1]) * (depth - curve[i - 1][0]) / (curve[i][0] - curve[i - 1][0]);
}

const Curve k_buffer{{0.0, 0.0}, {4e-3, 30e3}, {0.12, 250e3}, {0.21, 590e3}, {0.23, 2e6}},
    k_buffer_back{{0.0, 0.0}, {4e-3, 10e3}, {0.12, 90e3}, {0.21, 295e3}, {0.23, 1.7e6}}, k_gear{{0.0, 0.0}, {5e-3, 50e3}, {0.11, 700e3}},
    k_gear_back{{0.0, 0.0}, {5e-3, 15e3}, {0.11, 280e3}};

double pressing(const Curve& loading, const Curve& back, double depth, double rate) {
  if (depth <= 0.0) return 0.0;
  return rate >= 0.0 ? at(loading, depth) : at(back, depth);
}

struct Train {
  std::array<double, 3> x{0.0, 0.0, -0.2}, v{0.0, 0.0, 8.0 / 3.6}; // of the first, braked one; of the coupled one; of the one that runs
  double most = 0.0;                                               // force of the buffers that meet, N

  void step(double h) {
    constexpr std::array<double, 3> mass{40e3, 40e3, 87e3}, wheels{60e3, 1e3, 1e3};
    const double front = 2.0 * pressing(k_buffer, k_buffer_back, x[1] - x[0], v[1] - v[0]),
                 back = 2.0 * pressing(k_buffer, k_buffer_back, x[2] - x[1], v[2] - v[1]),
                 pull = pressing(k_gear, k_gear_back, x[0] - x[1] - 0.01, v[0] - v[1]);
    most = std::max(most, back);
    const std::array<double, 3> force{front - pull, back - front + pull, -back};
    for (std::size_t i = 0; i < 3; ++i) {
      const double free = v[i] + h * force[i] / mass[i], loss = h * wheels[i] / mass[i];
      v[i] = std::abs(free) <= loss ? 0.0 : free - std::copysign(loss, free); // Coulomb's law of one step
      x[i] += h * v[i];
    }
  }
};

} // namespace

TEST_CASE("three wagons shunt as three masses on a line do") {
  const MachineRun r("shunted_wagons");
  REQUIRE(r.is_complete());
  constexpr double h = 2e-6;
  Train train;
  double next = 0.0;
  for (long n = 0; n <= 1250000; ++n) {
    const double t = static_cast<double>(n) * h;
    if (t >= next - 0.5 * h) {
      // The other way is of the first order, and chatters where a buffer rests: microns in 2.5 s.
      CAPTURE(t);
      for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(r.at("wagon " + std::to_string(i + 1) + ".frame.vx", t) - train.v[i]) < 1e-3);
      next += 0.05;
    }
    train.step(h);
  }
  const std::vector<double> force = r.series("buffers 2.force");
  CHECK(*std::max_element(force.begin(), force.end()) == doctest::Approx(train.most).epsilon(1e-3));
  CHECK(r.run.result.statistics.energy_residual < 1e-6 * r.run.result.statistics.energy_exchanged);
}
