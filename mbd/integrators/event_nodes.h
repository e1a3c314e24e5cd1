// Event functions at the stages inside a step, and conclusions about their sign between them.
//
// An event function w is certain to be positive between neighbouring nodes x_j, x_{j+1} if
//
//   chord(x) − ½ M (x − x_j)(x_{j+1} − x) > 0,   M ≥ |w″| there,
//
// by the error of linear interpolation. M is four times the largest second difference of neighbouring nodes, which also covers a kink
// between them (as in the gap to a pin that is passed); with three gaps or fewer it is at least twice the range of w. w has exactly one
// root up to the first node where it is negative if it is certainly positive in all gaps before, and in the last gap certainly decreases,
// or is convex or concave.
//
// M is a bound because the nodes resolve the explicit time dependence (a step turns no harmonic by more than Integrator::k_largest_turn)
// and the motion (the error of the step was accepted). Stages only approximate the motion: what they leave uncertain is checked on dense
// output (EventFinder).
#pragma once

#include <array>
#include <vector>

namespace steplap {

/// Value and slope of an event function at an end of a step. The slope refers to the step as unit of time; NaN if unknown.
struct EventEnd {
  double value = 0.0, slope = 0.0;
};

/// An event function in a step.
struct EventStep {
  int slot = 0;
  /// The slot belongs to a joint whose bodies are merged into one cluster; such joints are not evaluated at every stage.
  bool is_merged = false;
  bool is_of_joint = false; ///< the slot belongs to a step-lap joint, whose capacity is proportional to its clamping force
  EventEnd start, end;
};

/// Values of all event functions at the stages of one step.
class EventNodes {
public:
  explicit EventNodes(int slots)
      : slots_(slots), stride_((slots + k_block - 1) / k_block * k_block), values_(static_cast<std::size_t>(k_most) * stride_),
        low_(stride_), high_(stride_) {}

  void clear() { count_ = 0; }
  /// Adds the values at `theta` (0 start, 1 end of the step). Values at the ends and beyond the capacity are ignored. `has_merged`:
  /// joints inside clusters were evaluated at this node; otherwise their values are from an earlier node.
  void add(double theta, const double* event_value, bool has_merged);

  /// Computes the range of each event function. To be called once after the last add(), before the functions below.
  void close(const double* event_value0, const double* event_value1);
  [[nodiscard]] double low(int slot) const { return low_[slot]; }
  [[nodiscard]] double high(int slot) const { return high_[slot]; }
  /// Returns true if the function is certainly positive in the step, except at the ends themselves.
  [[nodiscard]] bool is_proven_positive(const EventStep& watched) const;
  /// Returns true if the function certainly has exactly one root up to the first node where it is negative. Precondition: positive at the
  /// start and negative at the end.
  [[nodiscard]] bool crosses_once(const EventStep& watched) const;

private:
  static constexpr int k_most = 18;
  /// An event function at the nodes where it is known, including the ends.
  struct Curve {
    int last = 0;                                    ///< index of the last node
    std::array<double, k_most + 2> x{}, w{}, bend{}; ///< bend[j]: w″ from the second difference about node j
    double start_slope = 0.0, end_slope = 0.0;
    double most_bend = 0.0;                    ///< lower limit of M if there are few nodes, from the range of w
    [[nodiscard]] double bound(int gap) const; ///< returns M ≥ |w″| between nodes `gap` and `gap` + 1
    [[nodiscard]] bool is_positive_in(int gap) const;
    [[nodiscard]] bool falls_once_in(int gap) const;
  };
  [[nodiscard]] Curve curve_of(const EventStep& watched) const;
  static constexpr int k_block = 4; ///< alignment of the values of a node
  int slots_, stride_, count_ = 0;
  std::array<double, k_most> theta_{};
  std::array<int, k_most> order_{}; ///< nodes sorted by theta
  std::array<char, k_most> has_merged_{};
  std::vector<double> values_; ///< `stride_` numbers for each node
  std::vector<double> low_, high_;
};

} // namespace steplap
