// Dual numbers for forward automatic differentiation: a value with its derivatives by N variables. Element laws are templates over the
// number type, so their Jacobians are exact without a second hand-written version.
//
// Eigen's AutoDiffScalar is not used, because its expression templates defeat template argument deduction in Pair<S> and MeasureValue<S>.
#pragma once

#include "mbd/base/portable_math.h"

#include <Eigen/Core>

#include <cmath>

namespace steplap {

/// Value v and gradient d. Comparisons use the value only.
template <int N> struct Dual {
  double v = 0.0;
  Eigen::Array<double, N, 1> d = Eigen::Array<double, N, 1>::Zero();

  Dual() = default;
  Dual(double value) : v(value) {} // NOLINT: a constant is a Dual
  Dual(double value, const Eigen::Array<double, N, 1>& derivative) : v(value), d(derivative) {}
  /// Returns independent variable number `index`: derivative 1 with respect to itself, 0 with respect to others.
  static Dual variable(double value, int index) {
    Dual x(value);
    x.d[index] = 1.0;
    return x;
  }

  Dual& operator+=(const Dual& o) { return *this = *this + o; }
  Dual& operator-=(const Dual& o) { return *this = *this - o; }

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
  friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.d * b.v + b.d * a.v}; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.v / b.v;
    return {q, (a.d - q * b.d) / b.v};
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend Dual sqrt(const Dual& a) {
    const double r = std::sqrt(a.v);
    return {r, a.d / (2.0 * r)};
  }
  friend Dual sin(const Dual& a) {
    const auto [s, c] = portable::sin_cos(a.v);
    return {s, c * a.d};
  }
  friend Dual cos(const Dual& a) {
    const auto [s, c] = portable::sin_cos(a.v);
    return {c, -s * a.d};
  }
  friend Dual atan2(const Dual& y, const Dual& x) { return {portable::atan2(y.v, x.v), (x.v * y.d - y.v * x.d) / (x.v * x.v + y.v * y.v)}; }
  friend Dual pow(const Dual& a, double n) { return {portable::pow(a.v, n), n * portable::pow(a.v, n - 1.0) * a.d}; }
  friend Dual abs(const Dual& a) { return a.v < 0.0 ? -a : a; }
};

/// Returns the value without derivatives, for branches and table look-ups.
inline double value_of(double x) { return x; }
template <int N> double value_of(const Dual<N>& x) { return x.v; }

} // namespace steplap
