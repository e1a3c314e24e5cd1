#pragma once

// Scenes of variable size, as in bench_scaling: pendulum chains that fall from the horizontal (uniform rods, 1 m, 1 kg, 0.083 kg m² each),
// and square grids of masses on springs (1 kg, 1 m apart, 10 kN/m, 1 N s/m) suspended at their first row. Measures the cost of a step and
// of an evaluation per body.

#include "ladder.h"

#include <vector>

namespace steplap::peers {

constexpr double k_scaling_step = 1e-4; // step, s
constexpr double k_gravity = 9.81;
constexpr double k_rod_inertia = 0.083;
constexpr double k_grid_stiffness = 1e4, k_grid_damping = 1.0;

struct ScalingResult {
  double step_us = 0.0;     // CPU time of a step per body, µs
  double evaluations = 0.0; // number of evaluations per step
  double probe = 0.0;       // final y coordinate of the last body, m, for comparison of programs
};

[[nodiscard]] inline int steps_for(int bodies) { return bodies > 6000 ? 3 : 20000 / bodies; }

// Returns the CPU time per step and body, µs: the smallest of three batches of steps_for(bodies) steps each.
template <class Advance> [[nodiscard]] double least_step_us(int bodies, Advance advance) {
  const int steps = steps_for(bodies);
  double least = 1e300;
  for (int batch = 0; batch < 3; ++batch) {
    const double start = cpu_seconds();
    advance(steps);
    const double elapsed = cpu_seconds() - start;
    if (elapsed < least) least = elapsed;
  }
  return 1e6 * least / steps / bodies;
}

// Interface of a hand-written scene, whose state y contains positions, then velocities.
class ByHand {
public:
  virtual ~ByHand() = default;
  virtual void rates(const double* y, double* dy) = 0;
  [[nodiscard]] virtual std::vector<double> start() const = 0;
  [[nodiscard]] virtual double probe(const double* y) const = 0;
};

// Chain in absolute coordinates. Pin forces are the solution of a block-tridiagonal system.
class ChainByHand : public ByHand {
public:
  explicit ChainByHand(int rods);
  void rates(const double* y, double* dy) override;
  [[nodiscard]] std::vector<double> start() const override;
  [[nodiscard]] double probe(const double* y) const override { return y[3 * n_ - 2]; }

private:
  struct Block {
    double xx, xy, yy;
  };
  int n_;
  std::vector<double> rx_, ry_, px_, py_, fx_, fy_;
  std::vector<Block> inverse_;
};

// Grid of point masses with coordinates x and y.
class GridByHand : public ByHand {
public:
  explicit GridByHand(int side) : side_(side) {}
  void rates(const double* y, double* dy) override;
  [[nodiscard]] std::vector<double> start() const override;
  [[nodiscard]] double probe(const double* y) const override { return y[2 * side_ * side_ - 1]; }

private:
  void pull(const double* y, double* dy, int a, int b) const;
  int side_;
};

[[nodiscard]] ScalingResult run_rk4(ByHand& scene, int bodies);
[[nodiscard]] ScalingResult run_arkode(ByHand& scene, int bodies); // Dormand-Prince with fixed step
[[nodiscard]] ScalingResult run_chain_simbody(int rods);
[[nodiscard]] ScalingResult run_grid_simbody(int side);

} // namespace steplap::peers
