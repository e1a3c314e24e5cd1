// A smooth function on a part of a step, known at seven places of it: the polynomial p of order 6 through them, and what
// that says of the function f for certain.
//
// The places are those of Chebyshev and Lobatto on [0, 1]. With the Chebyshev coefficients a_0 … a_6 of p,
//   |f − p| ≤ E = 4 (|a_5| + |a_6|),    |f′ − p′| ≤ E′ = 48 E
// is assumed (docs/explanation/theory.md, "Events", says of what), and is to be held against f at a place where it was not known
// before. What follows from it is not sampled: on any stretch p lies between the least and the greatest of its Bernstein
// coefficients, p′ between their steepest differences, and as p = f at the seven places, |f − p| is no more than
// E′ times the distance from the next one either.
#pragma once

#include <array>
#include <cstddef>

namespace steplap {

class PartPolynomial {
public:
  static constexpr std::size_t k_order = 6;
  using Values = std::array<double, k_order + 1>;

  [[nodiscard]] static double place(std::size_t k);
  /// Between places `gap` and `gap` + 1, half way in the angle by which places are even: there a polynomial that is off is
  /// off by most.
  [[nodiscard]] static double between(std::size_t gap);

  void fit(const Values& values);
  [[nodiscard]] double largest() const { return largest_; } ///< size of the values
  [[nodiscard]] double error() const { return error_; }     ///< E
  /// It was seen to be off by more than that.
  void widen(double error) { error_ = error; }
  [[nodiscard]] double at(double x) const;

  /// The first gap between neighbouring places `from` … `to` where f may be below `floor`, given that it is not at the
  /// places; −1: there is none, for certain.
  [[nodiscard]] int doubtful_gap(double floor, std::size_t from, std::size_t to) const;
  /// Does f, from above `floor` to below it between places `gap` and `gap` + 1, for certain pass it once only?
  [[nodiscard]] bool falls_once(double floor, std::size_t gap) const;
  /// Where between places `from` and `to` p is least.
  [[nodiscard]] double lowest(std::size_t from, std::size_t to) const;

private:
  Values value_{}, chebyshev_{};
  std::array<Values, k_order> bernstein_{}; ///< of each gap
  double largest_ = 0.0, error_ = 0.0;
};

} // namespace steplap
