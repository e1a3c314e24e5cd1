#include "mbd/formula/enclosure.h"

#include "mbd/base/portable_math.h"

#include <numbers>

namespace steplap {

namespace {

constexpr double k_ulp = 0x1p-52;
constexpr double k_infinite = std::numeric_limits<double>::infinity();
constexpr double k_widest = 0.7;       // largest useful radius relative to the radius of convergence of a series
constexpr double k_widest_angle = 4.0; // for sines and exponentials, whose series converge everywhere
constexpr int k_largest_whole = 64;    // larger exponents are not expanded into products

template <int N> using Coefficients = std::array<double, N + 1>;

// Returns Σ |c_k| from k on.
template <int N> double size_from(const Coefficients<N>& c, int k) {
  double sum = 0.0;
  for (; k <= N; ++k) sum += std::abs(c[k]);
  return sum;
}

// Returns the range of Σ c_k uᵏ ± rest for |u| ≤ 1, exact up to the quadratic term.
template <int N> Interval range_of(const Coefficients<N>& c, double rest) {
  double low = c[0], high = c[0];
  if constexpr (N >= 2) {
    const double even = c[0] + c[2];
    low = even - std::abs(c[1]);
    high = even + std::abs(c[1]);
    if (std::abs(c[1]) < 2.0 * std::abs(c[2])) {
      const double vertex = c[0] - 0.25 * c[1] * (c[1] / c[2]);
      low = std::min(low, vertex);
      high = std::max(high, vertex);
    }
  }
  const double more = size_from<N>(c, 3) + rest + 8.0 * k_ulp * size_from<N>(c, 0);
  return {low - more, high + more};
}

// Sets the range of e to that of its polynomial, intersected with `natural`, the range from interval arithmetic. If the error bound of the
// polynomial exceeds half the width of the result, the polynomial is replaced by a constant.
template <int N> Enclosure<N> settled(Enclosure<N> e, const Interval& natural) {
  if (natural.is_empty()) {
    e.range = interval::k_none;
    e.rest = k_infinite;
    return e;
  }
  e.range = natural;
  if (e.has_polynomial()) {
    const Interval both = interval::common(natural, range_of<N>(e.c, e.rest));
    if (!both.is_empty()) e.range = both;
  }
  const double radius = e.range.radius();
  if (!(e.rest <= radius) && e.range.is_bounded()) {
    e.c = {};
    e.c[0] = e.range.middle();
    e.rest = radius * (1.0 + 2.0 * k_ulp) + k_ulp * std::abs(e.c[0]);
  }
  return e;
}

template <int N> void multiply_into(const Enclosure<N>& a, const Enclosure<N>& b, Enclosure<N>& product) {
  const double size_a = size_from<N>(a.c, 0), size_b = size_from<N>(b.c, 0);
  Coefficients<N> c{};
  double cut = 0.0;
  for (int i = 0; i <= N; ++i) {
    if (a.c[i] == 0.0) continue;
    for (int k = 0; i + k <= N; ++k) c[i + k] += a.c[i] * b.c[k];
    if (i > 0) cut += std::abs(a.c[i]) * size_from<N>(b.c, N + 1 - i);
  }
  product.c = c;
  product.rest = cut + size_a * b.rest + a.rest * (size_b + b.rest) + (2.0 * N + 4.0) * k_ulp * size_a * size_b;
}

// Returns Σ_k series_k (a − c₀)ᵏ, with c₀ the constant coefficient of a. `left_out` bounds the truncation error of the series.
template <int N> Enclosure<N> composed(const Enclosure<N>& a, const Coefficients<N>& series, double left_out) {
  Enclosure<N> shifted = a;
  shifted.c[0] = 0.0;
  Enclosure<N> sum;
  sum.c[0] = series[N];
  for (int k = N - 1; k >= 0; --k) {
    multiply_into<N>(sum, shifted, sum);
    sum.c[0] += series[k];
    sum.rest += 2.0 * k_ulp * std::abs(series[k]);
  }
  sum.rest += left_out;
  sum.is_partial = a.is_partial;
  return sum;
}

// Returns the largest possible |a − c₀|, with c₀ the constant coefficient of a.
template <int N> double reach(const Enclosure<N>& a) { return size_from<N>(a.c, 1) + a.rest; }

template <int N> Enclosure<N> without_polynomial(bool is_partial) {
  Enclosure<N> e;
  e.rest = k_infinite;
  e.is_partial = is_partial;
  return e;
}

double whole_power(double x, int n) {
  double value = 1.0;
  for (int i = 0; i < n; ++i) value *= x;
  return value;
}

// Returns a^p by the binomial series of (c₀ + D)^p, for a constant coefficient c₀ > 0.
template <int N> Enclosure<N> positive_power(const Enclosure<N>& a, double p) {
  const double c0 = a.c[0], q = reach<N>(a) / c0;
  const double growth = q * std::max(1.0, (std::abs(p) + N + 1) / (N + 2));
  if (!a.has_polynomial() || !(c0 > 0.0) || !(q <= k_widest) || !(growth < 1.0)) return without_polynomial<N>(a.is_partial);
  Coefficients<N> series;
  double term = portable::pow(c0, p), binomial = 1.0;
  const double size = term;
  for (int k = 0; k <= N; ++k) {
    series[k] = term;
    term *= (p - k) / ((k + 1) * c0);
    binomial *= (p - k) / (k + 1);
  }
  return composed<N>(a, series, size * std::abs(binomial) * whole_power(q, N + 1) / (1.0 - growth));
}

template <int N> Enclosure<N> negated(Enclosure<N> a) {
  for (double& c : a.c) c = -c;
  a.range = {-a.range.high, -a.range.low};
  return a;
}

template <int N> Enclosure<N> inverse(const Enclosure<N>& a) {
  return a.c[0] < 0.0 ? negated<N>(positive_power<N>(negated<N>(a), -1.0)) : positive_power<N>(a, -1.0);
}

// Returns sin a, or cos a if `is_cosine`, by the Taylor series about c₀.
template <int N> Enclosure<N> swung(const Enclosure<N>& a, bool is_cosine) {
  const double d = reach<N>(a);
  if (!a.has_polynomial() || !(d <= k_widest_angle)) return without_polynomial<N>(a.is_partial);
  const portable::SinCos at = portable::sin_cos(a.c[0]);
  const std::array<double, 4> cycle =
      is_cosine ? std::array{at.cos, -at.sin, -at.cos, at.sin} : std::array{at.sin, at.cos, -at.sin, -at.cos};
  Coefficients<N> series;
  double factorial = 1.0, left_out = 1.0;
  for (int k = 0; k <= N; ++k) {
    series[k] = cycle[k % 4] / factorial;
    factorial *= k + 1;
    left_out *= d / (k + 1);
  }
  return composed<N>(a, series, left_out);
}

// Returns atan a by the Taylor series about c₀, whose coefficients are cosᵏφ sin(k(φ + π/2))/k with φ = atan c₀. The truncated ones are at
// most cosᵏψ/k, where ψ is the smallest |angle| in the range.
template <int N> Enclosure<N> arctangent(const Enclosure<N>& a) {
  const double nearest = a.range.holds(0.0) ? 0.0 : std::min(std::abs(a.range.low), std::abs(a.range.high));
  const double q = reach<N>(a) / std::sqrt(1.0 + nearest * nearest);
  if (!a.has_polynomial() || !(q <= k_widest)) return without_polynomial<N>(a.is_partial);
  const double angle = portable::atan2(a.c[0], 1.0), cosine = 1.0 / std::sqrt(1.0 + a.c[0] * a.c[0]);
  Coefficients<N> series;
  series[0] = angle;
  double power = 1.0;
  for (int k = 1; k <= N; ++k) {
    power *= cosine;
    series[k] = power * portable::sin(k * (angle + 0.5 * std::numbers::pi)) / k;
  }
  return composed<N>(a, series, whole_power(q, N + 1) / (N + 1) + 64.0 * k_ulp * q);
}

// Returns |a|. If a changes sign, |a| is enclosed by the chord between the ends of its range and the largest deviation from the chord.
// Unlike an interval, this keeps the correlation with a.
template <int N> Enclosure<N> folded(const Enclosure<N>& a, const Interval& natural) {
  if (a.range.low >= 0.0) return settled<N>(a, natural);
  if (a.range.high <= 0.0) return settled<N>(negated<N>(a), natural);
  Enclosure<N> e = a;
  const double low = -a.range.low, high = a.range.high;
  const double slope = (high - low) / (high + low), half = high * (low / (high + low));
  for (double& c : e.c) c *= slope;
  e.c[0] += half;
  e.rest = std::abs(slope) * a.rest + half + 8.0 * k_ulp * (low + high);
  return settled<N>(e, natural);
}

enum class Truth { no, yes, open };

template <int N> Truth truth_of(const Enclosure<N>& a) {
  if (!a.range.holds(0.0)) return Truth::yes;
  return a.range.low == 0.0 && a.range.high == 0.0 ? Truth::no : Truth::open;
}

template <int N> Enclosure<N> of_truth(bool may_be_false, bool may_be_true, bool is_partial) {
  return Enclosure<N>::of_range({may_be_false ? 0.0 : 1.0, may_be_true ? 1.0 : 0.0}, is_partial);
}

template <int N> bool is_none(const Enclosure<N>& a) { return a.range.is_empty(); }

template <int N> Enclosure<N> none() {
  Enclosure<N> e = without_polynomial<N>(true);
  e.range = interval::k_none;
  return e;
}

} // namespace

template <int N> Enclosure<N> Enclosure<N>::of_number(double value) {
  Enclosure e;
  e.range = {value, value};
  e.c[0] = value;
  return e;
}

template <int N> Enclosure<N> Enclosure<N>::of_range(const Interval& range, bool is_partial) {
  return settled<N>(without_polynomial<N>(is_partial), range);
}

template <int N> Enclosure<N> Enclosure<N>::of_polynomial(const std::array<double, N + 1>& c, double rest) {
  Enclosure e;
  e.c = c;
  e.rest = rest;
  return settled<N>(e, range_of<N>(c, rest));
}

template <int N> double place_of_largest(const Enclosure<N>& e, double sign) {
  if constexpr (N < 2) return 0.0;
  const double slope = sign * e.c[1], bend = sign * e.c[2];
  if (bend < 0.0 && std::abs(slope) < -2.0 * bend) return -0.5 * slope / bend;
  return slope > 0.0 ? 1.0 : slope < 0.0 ? -1.0 : 0.0;
}

template <int N> Enclosure<N> EnclosingNumbers<N>::add(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  Value e;
  for (int k = 0; k <= N; ++k) e.c[k] = a.c[k] + b.c[k];
  e.rest = a.rest + b.rest + k_ulp * size_from<N>(e.c, 0);
  e.is_partial = a.is_partial || b.is_partial;
  return settled<N>(e, interval::add(a.range, b.range));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::negate(const Value& a) { return is_none(a) ? a : negated<N>(a); }
template <int N> Enclosure<N> EnclosingNumbers<N>::subtract(const Value& a, const Value& b) { return add(a, negate(b)); }

template <int N> Enclosure<N> EnclosingNumbers<N>::multiply(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  Value e = without_polynomial<N>(false);
  if (a.has_polynomial() && b.has_polynomial()) multiply_into<N>(a, b, e);
  if (std::isnan(e.rest)) e.rest = k_infinite;
  e.is_partial = a.is_partial || b.is_partial;
  return settled<N>(e, interval::multiply(a.range, b.range));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::divide(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  Value e = inverse<N>(b);
  if (e.has_polynomial() && a.has_polynomial()) multiply_into<N>(e, a, e);
  else e.rest = k_infinite;
  e.is_partial = a.is_partial || b.is_partial;
  const Interval natural = interval::divide(a.range, b.range, e.is_partial);
  return settled<N>(e, natural);
}

template <int N> Enclosure<N> EnclosingNumbers<N>::power(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  Value e = without_polynomial<N>(a.is_partial || b.is_partial);
  bool is_partial = e.is_partial;
  const Interval natural = interval::power(a.range, b.range, is_partial);
  if (b.range.low != b.range.high) {
    if (a.range.low > 0.0) e = exp(multiply(b, ln(a)));
  } else if (const double p = b.range.low; p >= 0.0 && p <= k_largest_whole && std::floor(p) == p && a.has_polynomial()) {
    e = Value::of_number(1.0);
    for (int k = 0; k < static_cast<int>(p); ++k) multiply_into<N>(e, a, e);
    if (std::isnan(e.rest)) e.rest = k_infinite;
  } else if (std::floor(p) == p && p < 0.0 && a.c[0] < 0.0) {
    e = positive_power<N>(negated<N>(a), p);
    if (std::fmod(p, 2.0) != 0.0) e = negated<N>(e);
  } else {
    e = positive_power<N>(a, p);
  }
  e.is_partial = is_partial;
  return settled<N>(e, natural);
}

template <int N> Enclosure<N> EnclosingNumbers<N>::abs(const Value& a) { return is_none(a) ? a : folded<N>(a, interval::abs(a.range)); }

template <int N> Enclosure<N> EnclosingNumbers<N>::sqrt(const Value& a) {
  if (is_none(a)) return a;
  Value e = positive_power<N>(a, 0.5);
  const Interval natural = interval::sqrt(a.range, e.is_partial);
  return settled<N>(e, natural);
}

template <int N> Enclosure<N> EnclosingNumbers<N>::hypot(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  Value e = without_polynomial<N>(false);
  if (a.has_polynomial() && b.has_polynomial()) {
    Value square_a, square_b;
    multiply_into<N>(a, a, square_a);
    multiply_into<N>(b, b, square_b);
    for (int k = 0; k <= N; ++k) square_a.c[k] += square_b.c[k];
    square_a.rest += square_b.rest + k_ulp * size_from<N>(square_a.c, 0);
    if (std::isfinite(square_a.rest)) e = positive_power<N>(square_a, 0.5);
  }
  e.is_partial = a.is_partial || b.is_partial;
  return settled<N>(e, interval::hypot(a.range, b.range));
}

// Returns max(a, b) = (a + b + |a − b|)/2, intersected with the maximum of the intervals.
template <int N> Enclosure<N> EnclosingNumbers<N>::max(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  const bool is_partial = a.is_partial || b.is_partial;
  const Value difference = subtract(a, b);
  Value e = difference.range.low >= 0.0 ? a : difference.range.high <= 0.0 ? b : without_polynomial<N>(is_partial);
  if (!e.has_polynomial() && difference.range.is_bounded()) e = multiply(Value::of_number(0.5), add(add(a, b), abs(difference)));
  e.is_partial = is_partial;
  return settled<N>(e, {std::max(a.range.low, b.range.low), std::max(a.range.high, b.range.high)});
}

template <int N> Enclosure<N> EnclosingNumbers<N>::min(const Value& a, const Value& b) { return negate(max(negate(a), negate(b))); }

template <int N> Enclosure<N> EnclosingNumbers<N>::sin(const Value& a) {
  return is_none(a) ? a : settled<N>(swung<N>(a, false), interval::sin(a.range));
}
template <int N> Enclosure<N> EnclosingNumbers<N>::cos(const Value& a) {
  return is_none(a) ? a : settled<N>(swung<N>(a, true), interval::cos(a.range));
}
template <int N> Enclosure<N> EnclosingNumbers<N>::tan(const Value& a) {
  if (is_none(a)) return a;
  Value e = divide(sin(a), cos(a));
  e.is_partial = a.is_partial; // no floating-point argument has a cosine of exactly zero
  return settled<N>(e, interval::tan(a.range));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::atan(const Value& a) {
  return is_none(a) ? a : settled<N>(arctangent<N>(a), interval::atan(a.range));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::atan2(const Value& y, const Value& x) {
  if (is_none(y) || is_none(x)) return none<N>();
  constexpr double k_quarter = 0.5 * std::numbers::pi;
  Value e = without_polynomial<N>(false);
  if (x.range.low > 0.0) e = atan(divide(y, x));
  else if (y.range.low > 0.0) e = subtract(Value::of_number(k_quarter), atan(divide(x, y)));
  else if (y.range.high < 0.0) e = subtract(Value::of_number(-k_quarter), atan(divide(x, y)));
  e.is_partial = y.is_partial || x.is_partial;
  return settled<N>(e, interval::atan2(y.range, x.range));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::asin(const Value& a) {
  if (is_none(a)) return a;
  const Value one = Value::of_number(1.0);
  Value e = atan2(a, sqrt(multiply(subtract(one, a), add(one, a))));
  e.is_partial = a.is_partial;
  const Interval natural = interval::asin(a.range, e.is_partial);
  return settled<N>(e, natural);
}
template <int N> Enclosure<N> EnclosingNumbers<N>::acos(const Value& a) {
  if (is_none(a)) return a;
  const Value one = Value::of_number(1.0);
  Value e = atan2(sqrt(multiply(subtract(one, a), add(one, a))), a);
  e.is_partial = a.is_partial;
  const Interval natural = interval::acos(a.range, e.is_partial);
  return settled<N>(e, natural);
}

template <int N> Enclosure<N> EnclosingNumbers<N>::exp(const Value& a) {
  if (is_none(a)) return a;
  const double d = reach<N>(a);
  Value e = without_polynomial<N>(a.is_partial);
  if (a.has_polynomial() && d <= k_widest_angle) {
    Coefficients<N> series;
    double term = portable::pow(std::numbers::e, a.c[0]), left_out = portable::pow(std::numbers::e, a.c[0] + d);
    for (int k = 0; k <= N; ++k) {
      series[k] = term;
      term /= k + 1;
      left_out *= d / (k + 1);
    }
    if (std::isfinite(left_out)) e = composed<N>(a, series, left_out);
  }
  e.is_partial = a.is_partial;
  return settled<N>(e, interval::exp(a.range));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::ln(const Value& a) {
  if (is_none(a)) return a;
  const double c0 = a.c[0], q = reach<N>(a) / c0;
  Value e = without_polynomial<N>(a.is_partial);
  if (a.has_polynomial() && c0 > 0.0 && q <= k_widest) {
    Coefficients<N> series;
    series[0] = portable::log10(c0) * std::numbers::ln10;
    double term = 1.0;
    for (int k = 1; k <= N; ++k) {
      term /= -c0;
      series[k] = -term / k;
    }
    e = composed<N>(a, series, whole_power(q, N + 1) / ((N + 1) * (1.0 - q)));
  }
  e.is_partial = a.is_partial;
  const Interval natural = interval::ln(a.range, e.is_partial);
  return settled<N>(e, natural);
}
template <int N> Enclosure<N> EnclosingNumbers<N>::log10(const Value& a) {
  return multiply(Value::of_number(1.0 / std::numbers::ln10), ln(a));
}

template <int N> Enclosure<N> EnclosingNumbers<N>::less(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  const Interval difference = subtract(a, b).range;
  return of_truth<N>(!(difference.high < 0.0), difference.low < 0.0, a.is_partial || b.is_partial);
}
template <int N> Enclosure<N> EnclosingNumbers<N>::less_or_equal(const Value& a, const Value& b) { return negation(less(b, a)); }
template <int N> Enclosure<N> EnclosingNumbers<N>::equal(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  const Interval difference = subtract(a, b).range;
  const bool is_same = difference.low == 0.0 && difference.high == 0.0;
  return of_truth<N>(!is_same, difference.holds(0.0), a.is_partial || b.is_partial);
}
template <int N> Enclosure<N> EnclosingNumbers<N>::both(const Value& a, const Value& b) {
  if (is_none(a) || is_none(b)) return none<N>();
  const Truth p = truth_of(a), q = truth_of(b);
  return of_truth<N>(p != Truth::yes || q != Truth::yes, p != Truth::no && q != Truth::no, a.is_partial || b.is_partial);
}
template <int N> Enclosure<N> EnclosingNumbers<N>::either(const Value& a, const Value& b) {
  return negation(both(negation(a), negation(b)));
}
template <int N> Enclosure<N> EnclosingNumbers<N>::negation(const Value& a) {
  if (is_none(a)) return a;
  const Truth p = truth_of(a);
  return of_truth<N>(p != Truth::no, p != Truth::yes, a.is_partial);
}

template <int N> Enclosure<N> EnclosingNumbers<N>::choice(const Value& condition, const Value& yes, const Value& no) {
  if (is_none(condition)) return condition;
  const Truth truth = truth_of(condition);
  if (truth != Truth::open) {
    Value e = truth == Truth::yes ? yes : no;
    e.is_partial = e.is_partial || condition.is_partial;
    return e;
  }
  const bool is_partial = condition.is_partial || yes.is_partial || no.is_partial || is_none(yes) || is_none(no);
  return Value::of_range(interval::hull(yes.range, no.range), is_partial);
}

// Marks where a formula has no finite value: an infinite result has none; a range without bound may include infinite values.
template <int N> Enclosure<N> EnclosingNumbers<N>::finite(const Value& a) {
  if (is_none(a)) return a;
  if (a.range.low == a.range.high && std::isinf(a.range.low)) return none<N>();
  Value e = a;
  e.is_partial = a.is_partial || !a.range.is_bounded();
  return e;
}

template struct Enclosure<0>;
template struct Enclosure<k_quartic>;
template struct Enclosure<k_enclosure_degree>;
template struct EnclosingNumbers<0>;
template struct EnclosingNumbers<k_quartic>;
template struct EnclosingNumbers<k_enclosure_degree>;
template double place_of_largest<k_enclosure_degree>(const Enclosure<k_enclosure_degree>&, double);

} // namespace steplap
