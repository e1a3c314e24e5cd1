// Where a smooth function crosses zero, from the few places where it is known.
//
// Along a step a switching function is nearly a polynomial. The one through all values (and slopes, where
// known) found so far gives the next place to look; its error falls by more digits with each.
#pragma once

#include <array>

namespace steplap {

class RootEstimate {
public:
  void clear() { n_ = 0; }
  /// The function has this value at x. A place may be given once; what is beyond the capacity is left out.
  void add(double x, double value);
  void add(double x, double value, double slope);
  /// Where in [low, high] the polynomial falls below zero, to `resolution`; an end, if it does not.
  [[nodiscard]] double root(double low, double high, double resolution) const;

private:
  void append(double x, double value);
  struct Value {
    double value, slope;
  };
  [[nodiscard]] Value at(double x) const;

  static constexpr int k_capacity = 14;
  int n_ = 0;
  std::array<double, k_capacity> x_{}, c_{}; ///< nodes, Newton's divided differences
  std::array<double, k_capacity> last_{};    ///< differences that end at the last node
};

} // namespace steplap
