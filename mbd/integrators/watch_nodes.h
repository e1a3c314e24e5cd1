// Watch values met at the stages inside a step, and what they tell between them.
//
// A value w of the step is certain to stay positive between neighbouring places x_j, x_{j+1} if
//   chord(x) − ½ M (x − x_j)(x_{j+1} − x) > 0,   M ≥ |w″| there,
// the error of linear interpolation. M is taken as four times the largest second difference through neighbouring places (a
// kink between them is bounded, too, as of the gap to a pin that is passed), of three gaps or fewer twice what w varies by at
// least. It passes zero once between a place where it is positive and the next one where it is negative if it does so for
// certain in no gap before, and there either only falls, by the same bound, or bends one way: what is convex or concave
// between a positive and a negative end has one root. Why M is a bound:
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

/// A watch value of a step.
struct WatchedStep {
  int slot = 0;
  bool is_merged = false;   ///< of a joint that is merged: not every place has looked at it
  bool is_of_joint = false; ///< of a joint that holds with a share of its grip
  WatchEnd start, end;
};

class WatchNodes {
public:
  explicit WatchNodes(int slots)
      : slots_(slots), stride_((slots + k_block - 1) / k_block * k_block), values_(static_cast<std::size_t>(k_most) * stride_),
        low_(stride_), high_(stride_) {}

  void clear() { count_ = 0; }
  /// Values at `theta` (0: the step's start, 1: its end); those at the ends, and beyond capacity, are not kept.
  /// `has_merged`: those of merged joints are of this place, and not what was left of an earlier look.
  void add(double theta, const double* watch, bool has_merged);

  /// Finds the range of each value, once, after the last add(); before the functions below.
  void close(const double* watch0, const double* watch1);
  [[nodiscard]] double low(int slot) const { return low_[slot]; }
  [[nodiscard]] double high(int slot) const { return high_[slot]; }
  /// Is this value certain to stay positive, but for the ends themselves?
  [[nodiscard]] bool is_surely_positive(const WatchedStep& watched) const;
  /// Does it for certain pass zero just once, up to the first place where it is negative? It is positive at the start and
  /// negative at the end.
  [[nodiscard]] bool crosses_once(const WatchedStep& watched) const;

private:
  static constexpr int k_most = 18;
  /// A value at the places that know it, the step's ends among them.
  struct Curve {
    int last = 0;                                    ///< index of the end
    std::array<double, k_most + 2> x{}, w{}, bend{}; ///< bend[j]: w″ by the difference about j
    double start_slope = 0.0, end_slope = 0.0;
    double most_bend = 0.0;                    ///< of w″ where few places show it, by what w varies by
    [[nodiscard]] double bound(int gap) const; ///< M between places `gap` and `gap` + 1
    [[nodiscard]] bool is_positive_in(int gap) const;
    [[nodiscard]] bool falls_once_in(int gap) const;
  };
  [[nodiscard]] Curve curve_of(const WatchedStep& watched) const;
  static constexpr int k_block = 4; ///< a place's values begin at multiples of so many
  int slots_, stride_, count_ = 0;
  std::array<double, k_most> theta_{};
  std::array<int, k_most> order_{}; ///< by theta
  std::array<char, k_most> has_merged_{};
  std::vector<double> values_; ///< `stride_` for each place
  std::vector<double> low_, high_;
};

} // namespace steplap
