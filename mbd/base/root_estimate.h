// Estimates a root of a smooth function from few samples.
//
// Along a step an event function is nearly a polynomial. The interpolating polynomial through all samples so far (values, and slopes where
// known) predicts the root; each further sample at the prediction multiplies the number of correct digits.
#pragma once

#include <array>

namespace steplap {

/// Samples of one function, and the root that they predict.
class RootEstimate {
public:
  void clear() { n_ = 0; }
  /// Adds the sample f(x) = value, and f′(x) = slope if given. Each x must be new. Samples beyond the capacity (14; a slope counts as one
  /// more) are ignored.
  void add(double x, double value);
  void add(double x, double value, double slope);
  /// Returns the point in [low, high] where the polynomial falls below zero, accurate to `resolution`, or an end of the interval if there
  /// is none.
  [[nodiscard]] double root(double low, double high, double resolution) const;

private:
  void append(double x, double value);
  struct Value {
    double value, slope;
  };
  [[nodiscard]] Value at(double x) const;

  static constexpr int k_capacity = 14;
  int n_ = 0;
  std::array<double, k_capacity> x_{}, c_{}; ///< nodes; Newton's divided differences
  std::array<double, k_capacity> last_{};    ///< divided differences that end at the last node
};

} // namespace steplap
