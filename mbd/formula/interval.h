// Interval arithmetic for the operations of formulas. Results contain all possible values and are rounded outward by two units in the last
// place, more than the errors of portable_math.h (not for results that underflow). A result is partial if some arguments have no value,
// such as square roots of negative numbers, and empty if none has.
#pragma once

#include <algorithm>
#include <limits>

namespace steplap {

/// Closed interval of real numbers; empty if low > high.
struct Interval {
  double low = 0.0, high = 0.0;

  [[nodiscard]] bool is_empty() const { return !(low <= high); }
  [[nodiscard]] bool holds(double x) const { return low <= x && x <= high; }
  [[nodiscard]] bool is_bounded() const { return low >= -std::numeric_limits<double>::max() && high <= std::numeric_limits<double>::max(); }
  [[nodiscard]] double middle() const { return 0.5 * low + 0.5 * high; }
  [[nodiscard]] double radius() const { return 0.5 * high - 0.5 * low; }
};

namespace interval {

/// The empty interval, and all numbers.
inline constexpr Interval k_none{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
inline constexpr Interval k_all{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

/// Returns [low, high] rounded outward; NaN counts as infinite.
[[nodiscard]] Interval widened(double low, double high);
[[nodiscard]] inline Interval hull(const Interval& a, const Interval& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
[[nodiscard]] inline Interval common(const Interval& a, const Interval& b) { return {std::max(a.low, b.low), std::min(a.high, b.high)}; }

// Precondition of the following functions: no argument is empty. `is_partial` is set to true if some arguments have no value, and otherwise
// left unchanged.
[[nodiscard]] Interval add(const Interval& a, const Interval& b);
[[nodiscard]] Interval subtract(const Interval& a, const Interval& b);
[[nodiscard]] Interval multiply(const Interval& a, const Interval& b);
[[nodiscard]] Interval divide(const Interval& a, const Interval& b, bool& is_partial);
[[nodiscard]] Interval power(const Interval& a, double exponent, bool& is_partial);
[[nodiscard]] Interval power(const Interval& a, const Interval& b, bool& is_partial);
[[nodiscard]] Interval abs(const Interval& a);
[[nodiscard]] Interval sqrt(const Interval& a, bool& is_partial);
[[nodiscard]] Interval hypot(const Interval& a, const Interval& b);
[[nodiscard]] Interval sin(const Interval& a);
[[nodiscard]] Interval cos(const Interval& a);
[[nodiscard]] Interval tan(const Interval& a);
[[nodiscard]] Interval asin(const Interval& a, bool& is_partial);
[[nodiscard]] Interval acos(const Interval& a, bool& is_partial);
[[nodiscard]] Interval atan(const Interval& a);
[[nodiscard]] Interval atan2(const Interval& y, const Interval& x);
[[nodiscard]] Interval exp(const Interval& a);
[[nodiscard]] Interval ln(const Interval& a, bool& is_partial);

} // namespace interval

} // namespace steplap
