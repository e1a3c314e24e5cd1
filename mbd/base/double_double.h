// Double-double arithmetic: a number is the unevaluated sum of two doubles, which gives about 106 bits.
//
// The rounding error of a sum of doubles is a double (O. Møller 1965, D. Knuth), and so is that of a product (T. J. Dekker, Numer. Math. 18
// (1971) 224). Preconditions: rounding to nearest and compilation without contraction to fused multiply-add. Products are exact for factors
// below 2^995 unless the last bits of the product underflow.
#pragma once

namespace steplap {

/// The number hi + lo.
struct DoubleDouble {
  double hi = 0.0, lo = 0.0; ///< |lo| ≤ half a unit in the last place of hi
};

/// Returns a + b exactly.
constexpr DoubleDouble two_sum(double a, double b) {
  const double s = a + b, b_seen = s - a;
  return {s, (a - (s - b_seen)) + (b - b_seen)};
}

/// Returns a + b exactly, for |a| ≥ |b| or a = 0. Cheaper than two_sum().
constexpr DoubleDouble quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// Splits a into the sum of two numbers of at most 26 significant bits (Dekker).
constexpr DoubleDouble halves(double a) {
  const double spread = 134217729.0 * a, high = spread - (spread - a); // 2²⁷ + 1
  return {high, a - high};
}

/// Returns a b exactly.
constexpr DoubleDouble two_product(double a, double b) {
  const DoubleDouble x = halves(a), y = halves(b);
  const double p = a * b;
  return {p, ((x.hi * y.hi - p) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo};
}

constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.hi, b.hi), low = two_sum(a.lo, b.lo);
  const DoubleDouble sum = quick_two_sum(high.hi, high.lo + low.hi);
  return quick_two_sum(sum.hi, sum.lo + low.lo);
}

constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.hi, b.hi);
  return quick_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double q = a.hi / b.hi;
  const DoubleDouble p = two_product(q, b.hi);
  return quick_two_sum(q, ((a.hi - p.hi) - p.lo + (a.lo - q * b.lo)) / b.hi);
}

} // namespace steplap
