// The polynomial through values at the points of Chebyshev and Lobatto of [0, 1], and its top wherever it lies.
//
// Of level l there are 2^l + 1 points θ_i = (1 − cos(π i / 2^l)) / 2, so that each level has the points of the one before.
// Between two neighbouring points the polynomial of degree n = 2^l is written in Bernstein's form,
//   p = Σ b_k C(n,k) s^k (1 − s)^(n−k),  0 ≤ s ≤ 1,
// which nowhere exceeds its largest coefficient. It is cut where its slope is zero (de Casteljau), or in the middle, and parts that
// cannot exceed what is found are left; so are gaps between points of which max |p″| w²/8 says that they cannot, w their
// width. So no gap is taken for lower than it is.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace steplap {

/// The polynomial through values at points of [0, 1]: the ends, and between them those of a Chebyshev grid of one of three levels.
class NodePolynomial {
public:
  static constexpr int k_levels = 3, k_last = 1 << k_levels; ///< place of the last point of the highest level
  /// By how much a polynomial may exceed its values at the points, of their spread: half of what Lebesgue's constant is above one.
  /// That is 1.25, 1.7988 and 2.2748 for the three levels.
  static constexpr double k_overshoot = 0.6375;
  /// At the points of the highest level; those of a lower one lie among them, first.
  using Values = std::array<double, k_last + 1>;

  /// Point `node` of the highest level.
  [[nodiscard]] static constexpr double theta(int node) { return k_theta[static_cast<std::size_t>(node)]; }
  /// From one point of a level to the next, in points of the highest level.
  [[nodiscard]] static constexpr int spacing(int level) { return k_last >> level; }

  /// The first 2^level + 1 of `values` count.
  NodePolynomial(int level, const Values& values) : level_(level), values_(values) {}
  /// Its value at a place in [0, 1].
  [[nodiscard]] double at(double theta) const;

  /// Of the values of a level at a node that the next one has between them: the barycentric weights, and their sum.
  struct Weights {
    std::array<double, k_last + 1> of{}; ///< the first 2^level + 1 count
    double sum = 0.0;                    ///< by which the weighted sum of values is divided
  };
  /// `theta`: a node of level + 1 that `level` has not.
  [[nodiscard]] static const Weights& weights_at(int level, double theta);

  /// May the curve through `values` (times `sign`, 1 or −1), known to `error`, be higher than `limit`? What parabolas through three
  /// points in a row show beyond them counts twice. `best`: the highest of the values, times the sign.
  [[nodiscard]] static bool may_exceed(double limit, double error, int level, const Values& values, double sign, double best);

  /// A largest value and where it lies.
  struct Top {
    double value; ///< of the polynomial
    double theta; ///< in [0, 1]
  };
  /// The largest value, to within `slack`, where one is above `floor`; else nothing.
  [[nodiscard]] std::optional<Top> top_above(double floor, double slack) const;

private:
  static constexpr std::array<double, k_last + 1> k_theta{0.0, 0.03806023374435662, 0.14644660940672624, 0.30865828381745512,
                                                          0.5, 0.69134171618254488, 0.85355339059327376, 0.96193976625564338,
                                                          1.0};
  /// Nowhere is |p″| more.
  [[nodiscard]] double largest_bend() const;

  int level_;
  Values values_;
};

} // namespace steplap
