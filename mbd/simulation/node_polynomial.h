// The polynomial through values at the points of Chebyshev and Lobatto of [0, 1], and its top wherever it lies.
//
// Of level l there are 2^l + 1 points θ_i = (1 − cos(π i / 2^l)) / 2, so that each level has the points of the one before.
// Between two neighbouring points the polynomial of degree n = 2^l is written in Bernstein's form,
//   p = Σ b_k C(n,k) s^k (1 − s)^(n−k),  0 ≤ s ≤ 1,
// which nowhere exceeds its largest coefficient. Cut at s = 1/2 (de Casteljau), the coefficients come nearer to the curve by
// four each time; parts that cannot exceed what is found are left. So no gap between points is taken for lower than it is.
#pragma once

#include <array>
#include <optional>

namespace steplap {

class NodePolynomial {
public:
  static constexpr int k_levels = 3, k_last = 1 << k_levels; ///< place of the last point of the highest level
  using Values = std::array<double, k_last + 1>;

  /// Point `node` of the highest level.
  [[nodiscard]] static double theta(int node);
  /// From one point of a level to the next, in points of the highest level.
  [[nodiscard]] static constexpr int spacing(int level) { return k_last >> level; }

  /// The first 2^level + 1 of `values` count.
  NodePolynomial(int level, const Values& values) : level_(level), values_(values) {}
  [[nodiscard]] double at(double theta) const;

  struct Top {
    double value, theta;
  };
  /// The largest value, to within `slack`, where one is above `floor`; else nothing.
  [[nodiscard]] std::optional<Top> top_above(double floor, double slack) const;

private:
  /// Of the parabola through three values about there.
  [[nodiscard]] Top vertex_about(double theta) const;

  int level_;
  Values values_;
};

} // namespace steplap
