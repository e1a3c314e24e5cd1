// One collocation step across a singular position of joints (for example a parallelogram that folds flat).
//
// Near such a position the relative rounding error of accelerations grows with the inverse square of the distance, and at the position
// they are undefined. The motion itself is smooth, so a polynomial through the accelerations on both sides continues it. The stages of
// Gauss' method of order 16 are eight states on the constraints, with the singular position between two of them; they are iterated until
// they converge. In contrast to explicit stages, each is then as accurate as the end of the step. (Hairer, Nørsett, Wanner, Solving ODEs
// I, II.7.)
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace steplap {

/// Records how near the steps have come to a singular position, by the smallest pivots of the constraints (Dynamics::least_pivot); a
/// pivot is about the square of the distance in rad². Copyable, so that it can be restored when a step is withdrawn.
class SingularApproach {
public:
  void restart() { start_ = highest_ = 1.0; }
  /// Stores the smallest pivot at the end of a step.
  void note_end(double pivot) {
    const bool is_first = highest_ == 1.0; // the first step defines the pivot far from the position
    start_ = pivot;
    highest_ = is_first ? pivot : std::max(highest_, pivot);
  }
  /// Returns true if a step whose smallest pivot is `lowest` came so near that rounding dominates its stages.
  [[nodiscard]] bool is_beside(double lowest) const { return lowest < k_crossed_pivot && lowest < 0.5 * highest_; }
  /// Returns true if the position should be crossed by collocation: the pivot decreases (and is not small throughout), and the start of
  /// the step is not so near that the step would be tiny.
  [[nodiscard]] bool is_ahead(double lowest) const { return is_beside(lowest) && lowest < start_ && start_ > k_closest_start; }

private:
  static constexpr double k_crossed_pivot = 2e-2, k_closest_start = 4e-4;

  double start_ = 1.0;   ///< pivot at t0; 1: unknown
  double highest_ = 1.0; ///< largest pivot since the last restart
};

/// Collocation by Gauss' method. Does not allocate after construction.
class SingularCrossing {
public:
  static constexpr int k_stages = 8;

  explicit SingularCrossing(int max_dimension);

  using Norm = std::function<double(const double* error)>;
  /// A collocation step, with the norm that defines its tolerance.
  struct Step {
    double t0 = 0.0, h = 0.0;
    const double* y0 = nullptr;
    const double* rate0 = nullptr;
    int n = 0;
    Norm norm;                                                           ///< error norm of a difference of states; 1 is the tolerance
    std::function<void(const double* rates, double theta)> record_stage; ///< called after the last evaluation of each stage
  };

  /// Returns the singular position as a fraction of the step (0 start, 1 end, above 1 beyond it); NaN if none is near.
  [[nodiscard]] double locate(Dynamics& dynamics, const Step& step);
  /// Returns the longest step, at most `left`, for which a position `ahead` s from its start lies between two stages, preferably in the
  /// middle gap, otherwise in a later one; 0 if there is none.
  [[nodiscard]] double length_with_gap_at(double ahead, double left) const;
  /// Computes the stages and the end y1 of the step. Returns the error norm, acceptable if ≤ 1; infinite if the iteration does not
  /// converge.
  double cross(Dynamics& dynamics, const Step& step, double* y1);
  /// Writes the state at t0 + theta h of the last step to `out`, before the end of the step was projected.
  void dense(double theta, const Step& step, double* out) const;

private:
  [[nodiscard]] double distance(Dynamics& dynamics, const Step& step, double theta);
  void begin_stage(Dynamics& dynamics, const Step& step, int stage);
  void evaluate(Dynamics& dynamics, const Step& step, int stage);
  void iterate(Dynamics& dynamics, const Step& step, double* y1);
  [[nodiscard]] bool settle(Dynamics& dynamics, const Step& step, double* y1);
  [[nodiscard]] double error_of(Dynamics& dynamics, const Step& step);
  double* state(int stage) { return state_.data() + static_cast<std::size_t>(stage) * stride_; }
  double* rate(int stage) { return rate_.data() + static_cast<std::size_t>(stage) * stride_; }
  [[nodiscard]] const double* rate(int stage) const { return rate_.data() + static_cast<std::size_t>(stage) * stride_; }

  int stride_;
  std::vector<double> state_, rate_, work_;
};

/// Nodes and coefficients of Gauss' method with k_stages stages on [0, 1].
struct GaussTable {
  static constexpr int n = SingularCrossing::k_stages;
  std::array<double, n> c{}, b{};
  std::array<std::array<double, n>, n> a{};
  std::array<std::array<double, n>, n> power{}; ///< Lagrange polynomial i = Σ_p power[i][p] θ^p

  /// Returns ∫₀^θ of the Lagrange polynomials.
  [[nodiscard]] std::array<double, n> weights_to(double theta) const;
  [[nodiscard]] std::array<double, n> weights_at(double theta) const;
};

[[nodiscard]] const GaussTable& gauss_table();

} // namespace steplap
