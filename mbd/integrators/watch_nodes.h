// Watch values met at the stages inside a step, and what they tell between them.
//
// A value w of the step is certain to stay positive between neighbouring places x_j, x_{j+1} if
//   chord(x) − ½ M (x − x_j)(x_{j+1} − x) > 0,   M ≥ |w″| there,
// the error of linear interpolation. M is taken as four times the largest second difference through neighbouring places (a kink
// between them is bounded, too, as of the gap to a pin that is passed):
// explicit time dependence is resolved by the places, since no step turns a harmonic of a load or drive further
// than Integrator::k_largest_turn, and motion is, since the step's error was accepted. Stages are approximations of
// the motion: what they do not make certain is looked at on dense output (EventFinder).
#pragma once

#include <array>
#include <vector>

namespace steplap {

/// Value and slope (per step, NaN where it is not known) of a watch value at an end of a step.
struct WatchEnd {
  double value = 0.0, slope = 0.0;
};

class WatchNodes {
public:
  explicit WatchNodes(int slots)
      : slots_(slots), stride_((slots + k_block - 1) / k_block * k_block),
        values_(static_cast<std::size_t>(k_most) * stride_), low_(stride_), high_(stride_) {}

  void clear() { count_ = 0; }
  /// Values at `theta` (0: the step's start, 1: its end); those at the ends, and beyond capacity, are not kept.
  void add(double theta, const double* watch);

  /// Finds the range of each value, once, after the last add(); before the functions below.
  void close(const double* watch0, const double* watch1);
  [[nodiscard]] double low(int slot) const { return low_[slot]; }
  [[nodiscard]] double high(int slot) const { return high_[slot]; }
  /// Is this value certain to stay positive, but for the ends themselves?
  [[nodiscard]] bool is_surely_positive(int slot, const WatchEnd& start, const WatchEnd& end) const;
  /// Does it change its sign just once, if it is positive at the start and negative at the end?
  [[nodiscard]] bool crosses_once(int slot) const;

private:
  static constexpr int k_most = 18;
  static constexpr int k_block = 4; ///< a place's values begin at multiples of so many
  int slots_, stride_, count_ = 0;
  std::array<double, k_most> theta_{};
  std::array<int, k_most> order_{}; ///< by theta
  std::vector<double> values_; ///< `stride_` for each place
  std::vector<double> low_, high_;
};

} // namespace steplap
