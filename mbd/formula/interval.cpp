#include "mbd/formula/interval.h"

#include "mbd/base/portable_math.h"

#include <cmath>
#include <numbers>

namespace steplap::interval {

namespace {

constexpr double k_outward = 0x1p-51;
constexpr double k_pi = std::numbers::pi;
constexpr double k_many_turns = 1e8; // for larger angles the quadrant is treated as unknown
constexpr double k_whole = 0x1p53;

double outward(double x) { return std::isfinite(x) ? k_outward * std::abs(x) : 0.0; }

// Zero times infinity is zero, since infinity represents arbitrarily large finite numbers.
double product(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : a * b; }

double logarithm(double x) { return portable::log10(x) * std::numbers::ln10; }

Interval of_corners(double p, double q, double r, double s) { return widened(std::min({p, q, r, s}), std::max({p, q, r, s})); }

// Return the smallest and the largest absolute value in the interval.
double nearest(const Interval& a) { return a.holds(0.0) ? 0.0 : std::min(std::abs(a.low), std::abs(a.high)); }
double farthest(const Interval& a) { return std::max(std::abs(a.low), std::abs(a.high)); }

// Returns true if the interval contains a point `at` + k `period`, k an integer, with a tolerance for rounding.
bool holds_periodic(const Interval& a, double at, double period) {
  const double slack = 1e-15 * (period + farthest(a));
  return std::floor((a.high + slack - at) / period) >= std::ceil((a.low - slack - at) / period);
}

Interval reciprocal(const Interval& b, bool& is_partial) {
  if (!b.holds(0.0)) return widened(1.0 / b.high, 1.0 / b.low);
  is_partial = true;
  const double infinite = std::numeric_limits<double>::infinity();
  if (b.low == 0.0 && b.high == 0.0) return k_all; // infinite or undefined; min, max or another quotient may still make use of it
  if (b.low == 0.0) return {widened(1.0 / b.high, 1.0 / b.high).low, infinite};
  if (b.high == 0.0) return {-infinite, widened(1.0 / b.low, 1.0 / b.low).high};
  return k_all;
}

// Returns the range of a to the power `exponent`, for a ≥ 0 or a positive integer exponent.
Interval positive_power(const Interval& a, double exponent) {
  const bool is_even = std::fmod(exponent, 2.0) == 0.0;
  if (is_even || a.low >= 0.0) {
    const Interval size = widened(portable::pow(nearest(a), exponent), portable::pow(farthest(a), exponent));
    return {std::max(0.0, size.low), size.high};
  }
  return widened(portable::pow(a.low, exponent), portable::pow(a.high, exponent));
}

Interval swing(const Interval& a, double top, double at_low, double at_high) {
  if (!(a.high - a.low < 2.0 * k_pi) || farthest(a) > k_many_turns) return {-1.0, 1.0};
  Interval ends = widened(std::min(at_low, at_high), std::max(at_low, at_high));
  if (holds_periodic(a, top, 2.0 * k_pi)) ends.high = 1.0;
  if (holds_periodic(a, top + k_pi, 2.0 * k_pi)) ends.low = -1.0;
  return common(ends, {-1.0, 1.0});
}

// Returns the part of the interval in [−1, 1], where asin and acos are defined.
Interval within_one(const Interval& a, bool& is_partial) {
  is_partial = is_partial || a.low < -1.0 || a.high > 1.0;
  return common(a, {-1.0, 1.0});
}

} // namespace

// Rounds outward. An end that is NaN, such as the difference of infinities, becomes infinite.
Interval widened(double low, double high) {
  return {std::isnan(low) ? k_all.low : low - outward(low), std::isnan(high) ? k_all.high : high + outward(high)};
}

Interval add(const Interval& a, const Interval& b) { return widened(a.low + b.low, a.high + b.high); }
Interval subtract(const Interval& a, const Interval& b) { return widened(a.low - b.high, a.high - b.low); }

Interval multiply(const Interval& a, const Interval& b) {
  return of_corners(product(a.low, b.low), product(a.low, b.high), product(a.high, b.low), product(a.high, b.high));
}

Interval divide(const Interval& a, const Interval& b, bool& is_partial) { return multiply(a, reciprocal(b, is_partial)); }

Interval power(const Interval& a, double exponent, bool& is_partial) {
  if (exponent == 0.0) return {1.0, 1.0};
  const bool is_whole = std::floor(exponent) == exponent && std::abs(exponent) < k_whole;
  Interval base = a;
  if (!is_whole && a.low < 0.0) {
    is_partial = true;
    base.low = 0.0;
    if (base.is_empty()) return k_none;
  }
  const Interval size = positive_power(base, std::abs(exponent));
  return exponent > 0.0 ? size : reciprocal(size, is_partial);
}

// Returns the range of a^b. For a positive base the power is monotonic in both arguments, so its extremes are at corners.
Interval power(const Interval& a, const Interval& b, bool& is_partial) {
  if (b.low == b.high) return power(a, b.low, is_partial);
  if (!(a.low > 0.0)) {
    is_partial = true;
    return k_all;
  }
  return of_corners(portable::pow(a.low, b.low), portable::pow(a.low, b.high), portable::pow(a.high, b.low), portable::pow(a.high, b.high));
}

Interval abs(const Interval& a) { return {nearest(a), farthest(a)}; }

Interval sqrt(const Interval& a, bool& is_partial) {
  is_partial = is_partial || a.low < 0.0;
  if (a.high < 0.0) return k_none;
  return widened(std::sqrt(std::max(0.0, a.low)), std::sqrt(a.high));
}

Interval hypot(const Interval& a, const Interval& b) {
  return widened(portable::hypot(nearest(a), nearest(b)), portable::hypot(farthest(a), farthest(b)));
}

Interval sin(const Interval& a) { return swing(a, 0.5 * k_pi, portable::sin(a.low), portable::sin(a.high)); }
Interval cos(const Interval& a) { return swing(a, 0.0, portable::cos(a.low), portable::cos(a.high)); }

Interval tan(const Interval& a) {
  if (!(a.high - a.low < k_pi) || farthest(a) > k_many_turns || holds_periodic(a, 0.5 * k_pi, k_pi)) return k_all;
  const portable::SinCos low = portable::sin_cos(a.low), high = portable::sin_cos(a.high);
  const Interval once = widened(low.sin / low.cos, high.sin / high.cos); // two rounding errors and that of the quotient
  return widened(once.low, once.high);
}

Interval asin(const Interval& a, bool& is_partial) {
  const Interval inside = within_one(a, is_partial);
  if (inside.is_empty()) return k_none;
  const auto value = [](double x) { return portable::atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); };
  return widened(value(inside.low), value(inside.high));
}

Interval acos(const Interval& a, bool& is_partial) {
  const Interval inside = within_one(a, is_partial);
  if (inside.is_empty()) return k_none;
  const auto value = [](double x) { return portable::atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); };
  return widened(value(inside.high), value(inside.low));
}

Interval atan(const Interval& a) { return widened(portable::atan2(a.low, 1.0), portable::atan2(a.high, 1.0)); }

// Returns the range of the angle. It jumps across the negative x axis; if the rectangle does not touch this half-axis, the extremes are at
// corners.
Interval atan2(const Interval& y, const Interval& x) {
  if (y.holds(0.0) && x.low <= 0.0) return {-k_pi, std::nextafter(k_pi, 4.0)};
  return of_corners(portable::atan2(y.low, x.low), portable::atan2(y.low, x.high), portable::atan2(y.high, x.low),
                    portable::atan2(y.high, x.high));
}

Interval exp(const Interval& a) {
  const Interval value = widened(portable::pow(std::numbers::e, a.low), portable::pow(std::numbers::e, a.high));
  return {std::max(0.0, value.low), value.high};
}

Interval ln(const Interval& a, bool& is_partial) {
  is_partial = is_partial || a.low <= 0.0;
  if (!(a.high > 0.0)) return k_none;
  return widened(a.low > 0.0 ? logarithm(a.low) : -std::numeric_limits<double>::infinity(), logarithm(a.high));
}

} // namespace steplap::interval
