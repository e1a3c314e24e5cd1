// Interpolating polynomial through values at Chebyshev–Lobatto points of [0, 1], and its maximum.
//
// Level l has the 2^l + 1 points θ_i = (1 − cos(π i / 2^l)) / 2, so that each level contains the points of the previous one. Between two
// neighbouring points the polynomial of degree n = 2^l is written in Bernstein form,
//
//   p = Σ b_k C(n,k) s^k (1 − s)^(n−k),  0 ≤ s ≤ 1,
//
// and does not exceed its largest coefficient. A gap is divided at the maximum (zero slope) or in the middle by de Casteljau's algorithm.
// Parts whose coefficients do not exceed the best value found are dropped, and so are gaps of width w that cannot exceed it by more than
// max |p″| w²/8. The maximum is therefore never missed.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace steplap {

/// Polynomial through values at the points of one of three levels of [0, 1].
class NodePolynomial {
public:
  static constexpr int k_levels = 3, k_last = 1 << k_levels; ///< index of the last point of the highest level
  /// Largest amount by which the polynomial can exceed its values at the points, relative to their range: half of (Lebesgue constant − 1).
  /// The Lebesgue constants of the three levels are 1.25, 1.7988 and 2.2748.
  static constexpr double k_overshoot = 0.6375;
  /// Values at the points of the highest level. A lower level uses the first 2^level + 1 entries.
  using Values = std::array<double, k_last + 1>;

  /// Returns the position of point `node` of the highest level.
  [[nodiscard]] static constexpr double theta(int node) { return k_theta[static_cast<std::size_t>(node)]; }
  /// Returns the distance between neighbouring points of a level, in indices of the highest level.
  [[nodiscard]] static constexpr int spacing(int level) { return k_last >> level; }

  /// Uses the first 2^level + 1 of `values`.
  NodePolynomial(int level, const Values& values) : level_(level), values_(values) {}
  /// Returns the value at theta in [0, 1].
  [[nodiscard]] double at(double theta) const;

  /// Weights for interpolation at a point of the next level, between the points of the present one (barycentric form).
  struct Weights {
    std::array<double, k_last + 1> of{}; ///< weights of the first 2^level + 1 values
    double sum = 0.0;                    ///< divisor of the weighted sum
  };
  /// Returns the weights for `theta`, a point of level + 1 that is not one of `level`.
  [[nodiscard]] static const Weights& weights_at(int level, double theta);

  /// Returns true if sign · curve may exceed `limit`, for the curve through `values` with the error `error`. `sign`: 1 or −1. The excess
  /// over the values is estimated as twice that of the parabolas through three consecutive points. `best`: the largest of sign · values.
  [[nodiscard]] static bool may_exceed(double limit, double error, int level, const Values& values, double sign, double best);

  /// A maximum and its position.
  struct Top {
    double value; ///< value of the polynomial
    double theta; ///< position in [0, 1]
  };
  /// Returns the maximum, accurate to `slack`, if it is above `floor`, otherwise nothing.
  [[nodiscard]] std::optional<Top> top_above(double floor, double slack) const;

private:
  static constexpr std::array<double, k_last + 1> k_theta{0.0, 0.03806023374435662, 0.14644660940672624, 0.30865828381745512,
                                                          0.5, 0.69134171618254488, 0.85355339059327376, 0.96193976625564338,
                                                          1.0};
  /// Returns a bound of |p″| on [0, 1].
  [[nodiscard]] double largest_bend() const;

  int level_;
  Values values_;
};

} // namespace steplap
