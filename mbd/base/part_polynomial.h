// Interpolation of a smooth function f on a part of a time step, and rigorous statements about its sign.
//
// p is the polynomial of degree 6 through the values of f at the seven Chebyshev–Lobatto nodes of [0, 1]. With the Chebyshev coefficients
// a_0 … a_6 of p, the error is assumed to be bounded by
//
//   |f − p| ≤ E = 4 (|a_5| + |a_6|),    |f′ − p′| ≤ E′ = 48 E
//
// (docs/explanation/theory.md, "Events", states for which functions). The caller must check this assumption against f at a further point.
// Given E, no sampling is needed: on any subinterval p lies between its least and largest Bernstein coefficient, and p′ between the least
// and largest difference of neighbouring ones. Near a node x_k the bound is sharper, |f − p| ≤ E′ |x − x_k|, since p = f there.
#pragma once

#include <array>
#include <cstddef>

namespace steplap {

/// Polynomial p with its error bound E.
class PartPolynomial {
public:
  static constexpr std::size_t k_order = 6;
  using Values = std::array<double, k_order + 1>;

  /// Returns node k, 0 … 6, in ascending order on [0, 1].
  [[nodiscard]] static double node(std::size_t k);
  /// Returns a point between nodes `gap` and `gap` + 1, at the middle in the Chebyshev angle. The interpolation error is largest near it.
  [[nodiscard]] static double between(std::size_t gap);

  /// Computes p and E from the values of f at the nodes.
  void fit(const Values& values);
  [[nodiscard]] double largest() const { return largest_; } ///< max |f| over the nodes
  [[nodiscard]] double error() const { return error_; }     ///< E
  /// Replaces E. To be called if a larger error was observed.
  void widen(double error) { error_ = error; }
  /// Returns p(x).
  [[nodiscard]] double at(double x) const;

  /// Returns the first gap k (between nodes k and k + 1, `from` ≤ k < `to`) in which f < `floor` cannot be excluded; −1 if it can be
  /// excluded in all of them. Precondition: f ≥ `floor` at these nodes.
  [[nodiscard]] int first_uncertain_gap(double floor, std::size_t from, std::size_t to) const;
  /// Returns true if f certainly falls below `floor` exactly once in the gap, given that it is above at its left node and below at its
  /// right one.
  [[nodiscard]] bool falls_once(double floor, std::size_t gap) const;
  /// Returns the point between nodes `from` and `to` at which p is least.
  [[nodiscard]] double lowest(std::size_t from, std::size_t to) const;

private:
  Values value_{}, chebyshev_{};
  std::array<Values, k_order> bernstein_{}; ///< Bernstein coefficients for each gap
  double largest_ = 0.0, error_ = 0.0;
};

} // namespace steplap
