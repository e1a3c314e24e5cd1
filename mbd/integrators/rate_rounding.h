// Rounding errors of rates, below which no tolerance makes steps more accurate.
//
// The stages of a step evaluate y' = f(y) where y is rounded. A force of stiffness k is then known to k times the rounding of places, and
// the acceleration of a mass m to that over m. Over a step of length h this changes coordinate i by about
//
//   ε_i = h |f_i(y + δ) − f_i(y)|,   δ: rounding errors of y with pseudo-random signs,
//
// and a place by h times the change of its velocity. The estimated error of a step falls no lower, whatever the order of the method, so
// that a step controlled to less than ε becomes a hundred times shorter than its motion needs. In error norms the larger of tolerance and ε
// counts.
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <cstdint>
#include <vector>

namespace steplap {

/// Measures rounding errors of rates at the start of a leg, and now and then within it, since stiffness may grow with depth.
class RateRounding {
public:
  /// From this relative tolerance on rounding is not measured: only contacts much stiffer than those of steel have larger errors by it. With a
  /// floor at larger tolerances `dop853` would no longer notice that `rodas5p` costs less (tests/physics/auto_cost_test.cpp).
  static constexpr double k_least_tolerance = 1e-11;

  explicit RateRounding(int max_dimension) : size_(max_dimension, 0.0) {}

  /// Starts another leg, about which nothing is known.
  void restart();
  /// To be called once before each step from (t, y), where the rates are dy. The first and each k_interval-th call evaluates once more;
  /// `scratch` has room for two states. `length`: size of the bodies, m.
  void note_step(Dynamics& dynamics, double t, const double* y, const double* dy, double length, double* scratch);
  [[nodiscard]] bool is_known() const { return is_known_; }
  /// Returns by how much rounding changes number i of the state in a step of length h, s. Precondition: is_known().
  [[nodiscard]] double over_step(int i, double h) const {
    const auto k = static_cast<std::size_t>(i);
    return h * (size_[k] + (i < coordinates_ ? h * size_[k + static_cast<std::size_t>(coordinates_)] : 0.0));
  }

private:
  static constexpr int k_interval = 8;
  void measure(Dynamics& dynamics, double t, const double* y, const double* dy, double length, double* scratch);

  std::vector<double> size_; ///< largest of the leg, per number of the state
  int steps_ = 0;            ///< in this leg
  int coordinates_ = 0;      ///< whose rates follow them in the state
  std::uint32_t signs_ = 0;  ///< state of the generator of signs
  bool is_known_ = false;
};

} // namespace steplap
