// One step across a singular position of the joints (a parallelogram that folds flat), by collocation.
//
// Accelerations beside such a position are known to rounding over the square of the distance from it, those
// of states off the constraints not even so far, and at the position itself not at all. But the motion is as
// smooth there as elsewhere: a polynomial through the accelerations on either side carries it across. The
// stages of Gauss' method of order 16 are eight states on the constraints, the position in the gap between
// two of them, and are iterated until they agree: each is then as accurate as the end, unlike the stages of
// an explicit method. (Hairer, Nørsett, Wanner, Solving ODEs I, II.7.)
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace steplap {

/// How near to a singular position of the joints steps have come: pivots of the constraints (Dynamics::lowest_pivot),
/// squares of distances in rad². Copied to be taken back with a step.
class SingularApproach {
public:
  void restart() { start_ = highest_ = 1.0; }
  /// A step was made that has this smallest pivot at its end.
  void note_end(double pivot) {
    const bool is_first = highest_ == 1.0; // the first step's end tells what is usual here
    start_ = pivot;
    highest_ = is_first ? pivot : std::max(highest_, pivot);
  }
  /// Came a step whose lowest pivot this is so near that rounding rules its stages?
  [[nodiscard]] bool is_beside(double lowest) const { return lowest < k_crossed_pivot && lowest < 0.5 * highest_; }
  /// Is it to be crossed by collocation: falling towards a singular position, not merely small all the time, and not so near
  /// at the start that the step would have to be tiny?
  [[nodiscard]] bool is_ahead(double lowest) const { return is_beside(lowest) && lowest < start_ && start_ > k_closest_start; }

private:
  static constexpr double k_crossed_pivot = 2e-2, k_closest_start = 4e-4;

  double start_ = 1.0;   ///< at t0, 1: not known
  double highest_ = 1.0; ///< since the last restart
};

class SingularCrossing {
public:
  static constexpr int k_stages = 8;

  explicit SingularCrossing(int max_dimension);

  using Norm = std::function<double(const double* error)>;
  struct Step {
    double t0 = 0.0, h = 0.0;
    const double* y0 = nullptr;
    const double* rate0 = nullptr;
    int n = 0;
    Norm norm;                                                         ///< 1: as large as tolerated
    std::function<void(const double* rates, double theta)> note_stage; ///< after each stage's last evaluation
  };

  /// Where in a step (0: its start, 1: its end, above 1: beyond it) the joints are singular; NaN if nowhere near.
  [[nodiscard]] double locate(Dynamics& dynamics, const Step& step);
  /// The longest step not above `left` that has what lies `ahead` s from its start in a gap of its stages: in
  /// the middle one if it can, else in a later one; 0 if there is none.
  [[nodiscard]] double length_with_gap_at(double ahead, double left) const;
  /// Stages and end of the step. Returns its error, accepted when ≤ 1; infinite if the stages do not agree.
  double cross(Dynamics& dynamics, const Step& step, double* y1);
  /// State at t0 + theta h of the step last crossed, before its end was projected.
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

  /// ∫₀^θ of the Lagrange polynomials.
  [[nodiscard]] std::array<double, n> weights_to(double theta) const;
  [[nodiscard]] std::array<double, n> weights_at(double theta) const;
};

[[nodiscard]] const GaussTable& gauss_table();

} // namespace steplap
