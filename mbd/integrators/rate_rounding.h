// Rounding errors of rates, below which no tolerance makes steps more accurate.
//
// The stages of a step evaluate y' = f(y) at a rounded state y. A force of stiffness k then has an error of k times the rounding error of
// positions, and the acceleration of a mass m has that error divided by m. Over a step of length h this changes number i of the state by
//
//   ε_i ≈ h |f_i(y + δ) − f_i(y)|,   δ: rounding errors of y with pseudo-random signs.
//
// A position changes in addition by h times the change of its velocity. The estimated error of a step does not become smaller than ε,
// whatever the order of the method. Step control to less than ε would choose steps a hundred times shorter than the motion requires, so
// error norms use the larger of tolerance and ε (Integrator::error_norm()).
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <cstdint>
#include <vector>

namespace steplap {

/// Measures rounding errors of rates at the start of a leg, and again every few steps, because the stiffness of a contact may increase with
/// its depth.
class RateRounding {
public:
  /// Rounding is measured only if the relative tolerance is smaller than this value. At larger tolerances ε exceeds the tolerance only for
  /// contacts much stiffer than those of steel. With ε in the error norms there, `auto` would keep `dop853` where `rodas5p` costs
  /// less (tests/physics/auto_cost_test.cpp).
  static constexpr double k_least_tolerance = 1e-11;

  explicit RateRounding(int max_dimension) : size_(max_dimension, 0.0) {}

  /// Starts another leg. Discards all measurements.
  void restart();
  /// Must be called once before each step from (t, y) with rates dy. The first call and every k_interval-th call evaluate the rates once
  /// more. `scratch`: memory for two states; `length`: size of the bodies, m.
  void note_step(Dynamics& dynamics, double t, const double* y, const double* dy, double length, double* scratch);
  [[nodiscard]] bool is_known() const { return is_known_; }
  /// Returns the change of number i of the state by rounding in a step of length h, s. Precondition: is_known().
  [[nodiscard]] double over_step(int i, double h) const {
    const auto k = static_cast<std::size_t>(i);
    return h * (size_[k] + (i < coordinates_ ? h * size_[k + static_cast<std::size_t>(coordinates_)] : 0.0));
  }

private:
  static constexpr int k_interval = 8;
  void measure(Dynamics& dynamics, double t, const double* y, const double* dy, double length, double* scratch);

  std::vector<double> size_; ///< largest measured change of the rate in this leg, per number of the state
  int steps_ = 0;            ///< number of steps in this leg
  int coordinates_ = 0;      ///< number of coordinates at the start of the state; their rates follow
  std::uint32_t signs_ = 0;  ///< state of the generator of signs
  bool is_known_ = false;
};

} // namespace steplap
