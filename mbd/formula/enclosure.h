// Enclosure of a formula over a short time interval: a polynomial in u, |u| ≤ 1, with a bound of its error (a Taylor model, K. Makino and
// M. Berz, Int. J. Pure Appl. Math. 4 (2003) 379), together with the interval of its values.
//
// The polynomial preserves correlations between operands, so that a difference of large numbers is not overestimated. Its error decreases
// with the power degree + 1 of the interval length. If a function has a kink, a pole or a limit of its domain within the interval, only the
// interval of values is kept, which shrinks with the time interval. Degree 0 is for single points. Rounding errors are included, so the
// enclosures are rigorous.
#pragma once

#include "mbd/formula/formula_tree.h"
#include "mbd/formula/interval.h"

#include <array>
#include <cmath>
#include <limits>

namespace steplap {

/// Enclosure of f(u), |u| ≤ 1: f(u) lies in `range`, and within `rest` of the polynomial Σ c_k uᵏ.
template <int Degree> struct Enclosure {
  Interval range;
  std::array<double, Degree + 1> c{}; ///< coefficients of 1, u, u² …
  double rest = 0.0;                  ///< bound of |f − polynomial|; infinite if there is no polynomial
  bool is_partial = false;            ///< the formula may have no value somewhere in the interval

  [[nodiscard]] bool has_polynomial() const { return std::isfinite(rest); }
  [[nodiscard]] double polynomial(double u) const {
    double sum = c[Degree];
    for (int k = Degree - 1; k >= 0; --k) sum = sum * u + c[k];
    return sum;
  }

  [[nodiscard]] static Enclosure of_number(double value);
  [[nodiscard]] static Enclosure of_range(const Interval& range, bool is_partial = false);
  [[nodiscard]] static Enclosure of_polynomial(const std::array<double, Degree + 1>& c, double rest);
};

/// Returns the u, |u| ≤ 1, at which `sign` (1 or −1) times the polynomial, truncated after u², is largest.
template <int Degree> [[nodiscard]] double place_of_largest(const Enclosure<Degree>& e, double sign);

/// Operations on enclosures, for evaluate() (formula_tree.h).
template <int Degree> struct EnclosingNumbers {
  using Value = Enclosure<Degree>;
  static Value number(double a) { return Value::of_number(a); }
  static Value add(const Value& a, const Value& b);
  static Value subtract(const Value& a, const Value& b);
  static Value multiply(const Value& a, const Value& b);
  static Value divide(const Value& a, const Value& b);
  static Value power(const Value& a, const Value& b);
  static Value negate(const Value& a);
  static Value abs(const Value& a);
  static Value sqrt(const Value& a);
  static Value hypot(const Value& a, const Value& b);
  static Value min(const Value& a, const Value& b);
  static Value max(const Value& a, const Value& b);
  static Value sin(const Value& a);
  static Value cos(const Value& a);
  static Value tan(const Value& a);
  static Value asin(const Value& a);
  static Value acos(const Value& a);
  static Value atan(const Value& a);
  static Value atan2(const Value& y, const Value& x);
  static Value exp(const Value& a);
  static Value ln(const Value& a);
  static Value log10(const Value& a);
  static Value less(const Value& a, const Value& b);
  static Value less_or_equal(const Value& a, const Value& b);
  static Value equal(const Value& a, const Value& b);
  static Value both(const Value& a, const Value& b);
  static Value either(const Value& a, const Value& b);
  static Value negation(const Value& a);
  static Value choice(const Value& condition, const Value& yes, const Value& no);
  static Value finite(const Value& a);
};

inline constexpr int k_enclosure_degree = 8;
inline constexpr int k_quartic = 4; ///< degree of the polynomials through five samples of a step
extern template struct EnclosingNumbers<0>;
extern template struct EnclosingNumbers<k_quartic>;
extern template struct EnclosingNumbers<k_enclosure_degree>;

} // namespace steplap
