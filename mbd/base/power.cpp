#include "mbd/base/portable_math.h"

#include "mbd/base/double_double.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace steplap::portable {

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

constexpr DoubleDouble k_ln2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
// ln 2 as a multiple of a small power of two plus a remainder. The product of the multiple with the integers used is exact.
constexpr DoubleDouble k_ln2_times_17_bits{0x1.62e42fefap-1, 0x1.cf79abc9e3b3ap-40};
constexpr DoubleDouble k_ln2_on_grid{0x1.62e42fefa3800p-1, 0x1.ef35793c76730p-45};
constexpr double k_grid = 0x1p-42;
constexpr DoubleDouble k_per_ln10{0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};

/// Table entry for numbers in [1 + i/128, 1 + (i+1)/128); from √2 on, in half that interval. `inverse` is a 9-bit approximation of the
/// reciprocal. The logarithm is that of the reciprocal with opposite sign, and its `hi` is a multiple of 2⁻⁴².
struct LogEntry {
  double inverse = 1.0;
  DoubleDouble log;
};
constexpr int k_first_halved = 53;

// Returns 2 atanh s by its series.
constexpr DoubleDouble twice_atanh(const DoubleDouble& s) {
  const DoubleDouble square = s * s;
  DoubleDouble sum, power = s;
  for (int k = 1; k < 80; k += 2) {
    sum = sum + power / DoubleDouble{static_cast<double>(k), 0.0};
    power = power * square;
  }
  return {2.0 * sum.hi, 2.0 * sum.lo};
}

constexpr std::array<LogEntry, 128> make_logs() {
  std::array<LogEntry, 128> table;
  for (int i = 1; i < 127; ++i) { // at both ends the reciprocal is 1, so that nothing cancels for x near 1
    const double middle = (1.0 + (i + 0.5) / 128) * (i < k_first_halved ? 1.0 : 0.5);
    const int n = static_cast<int>(512.0 / middle + 0.5);
    table[i].inverse = n / 512.0;
    const DoubleDouble log = twice_atanh(DoubleDouble{512.0 - n, 0.0} / DoubleDouble{512.0 + n, 0.0});
    constexpr double round = 0x1.8p52 * k_grid;
    const double on_grid = (log.hi + round) - round;
    table[i].log = {on_grid, (log.hi - on_grid) + log.lo};
  }
  return table;
}

// Table of 2^(j/64), by the exponential series.
constexpr std::array<DoubleDouble, 64> make_powers() {
  std::array<DoubleDouble, 64> table;
  for (int j = 0; j < 64; ++j) {
    const DoubleDouble x = DoubleDouble{j / 64.0, 0.0} * k_ln2;
    DoubleDouble sum{1.0, 0.0}, term{1.0, 0.0};
    for (int k = 1; k < 30; ++k) {
      term = term * x / DoubleDouble{static_cast<double>(k), 0.0};
      sum = sum + term;
    }
    table[j] = sum;
  }
  return table;
}

constexpr std::array<LogEntry, 128> k_logs = make_logs();
constexpr std::array<DoubleDouble, 64> k_powers = make_powers();

// Returns x rounded to 53 − N bits.
template <int N> double without_last(double x) {
  constexpr std::uint64_t half = std::uint64_t{1} << (N - 1);
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + half) & ~std::uint64_t{0} << N);
}

// Returns log x for positive finite x with relative error 2⁻⁶⁷. With x = 2^e z, z times the table's reciprocal is 1 + r, where r = h + l
// exactly, h has 20 bits and |r| < 2⁻⁷. The terms e ln 2, table logarithm and h are multiples of 2⁻⁴² with an exact sum; h² is exact; the
// rounding errors of the sum with h²/2 and l are kept. The first omitted term of the series is r¹¹/11.
DoubleDouble log_of(double x) {
  auto bits = std::bit_cast<std::uint64_t>(x);
  int e = -1023;
  if (bits < 0x10000000000000) { // subnormal
    bits = std::bit_cast<std::uint64_t>(x * 0x1p54);
    e -= 54;
  }
  e += static_cast<int>(bits >> 52);
  const auto i = static_cast<int>(bits >> 45 & 127);
  const bool is_halved = i >= k_first_halved;
  e += is_halved;
  const double z = std::bit_cast<double>((bits & 0xfffffffffffff) | (is_halved ? 0x3fe0000000000000 : 0x3ff0000000000000));
  const double z_high = without_last<36>(z);
  const LogEntry& t = k_logs[i];
  const double h = z_high * t.inverse - 1.0, l = (z - z_high) * t.inverse;
  const double y = h + l, y2 = y * y;
  const double cubic =
      (1.0 / 3 - y * (1.0 / 4)) + y2 * ((1.0 / 5 - y * (1.0 / 6)) + y2 * ((1.0 / 7 - y * (1.0 / 8)) + y2 * (1.0 / 9 - y * (1.0 / 10))));
  const double exact = (e * k_ln2_on_grid.hi + t.log.hi) + h;
  const DoubleDouble first = quick_two_sum(exact, -0.5 * h * h), second = quick_two_sum(first.hi, l);
  const double small = ((first.lo + second.lo) + (e * k_ln2_on_grid.lo + t.log.lo)) + (y * y2 * cubic - l * (h + 0.5 * l));
  return quick_two_sum(second.hi, small);
}

// Returns e^(hi + lo) for |lo| ≤ 2⁻²⁴ |hi|. The argument is written as k ln 2/64 + r, with |r| slightly above ln 2/128 at most; the first
// omitted term of e^r − 1 = r + r²/2 + … is r⁷/7!. Subnormal results are rounded twice.
double exp_of(double hi, double lo) {
  if (hi > 710.0) return k_infinity;
  if (hi < -746.0) return 0.0;
  constexpr double round = 0x1.8p52;
  const double k = (hi * (64.0 / k_ln2.hi) + round) - round;
  const DoubleDouble r = two_sum(hi - k * (k_ln2_times_17_bits.hi / 64), lo - k * (k_ln2_times_17_bits.lo / 64));
  const double y = r.hi, y2 = y * y;
  const double growth = y + (r.lo + y2 * ((0.5 + y * (1.0 / 6)) + y2 * ((1.0 / 24 + y * (1.0 / 120)) + y2 * (1.0 / 720))));
  const auto n = static_cast<int>(k);
  const DoubleDouble& power = k_powers[n & 63];
  const double value = power.hi + (power.lo + power.hi * growth);
  const int e = n >> 6, half = e / 2;
  const auto two_to = [](int i) { return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + i) << 52); };
  return value * two_to(half) * two_to(e - half);
}

// Returns x^y for positive x where neither argument is zero, infinite or NaN. The product y log x is computed in two parts, of which the
// larger is exact.
double positive_power(double x, double y) {
  const DoubleDouble log = log_of(x);
  const double y_high = without_last<27>(y), log_high = without_last<27>(log.hi);
  const double log_low = (log.hi - log_high) + log.lo;
  return exp_of(y_high * log_high, (y - y_high) * log_high + y * log_low);
}

bool is_integer(double y) { return std::floor(y) == y; }
bool is_odd(double y) { return std::abs(y) < 0x1p53 && is_integer(y) && !is_integer(0.5 * y); }

// Returns x^y for x zero or infinite and y finite, not zero.
double power_of_extreme(double x, double y) {
  const bool becomes_infinite = (x == 0.0) == (y < 0.0);
  return std::copysign(becomes_infinite ? k_infinity : 0.0, is_odd(y) ? x : 1.0);
}

double power_to_infinity(double x, double y) { // |x| not 0, 1 or ∞
  return (std::abs(x) > 1.0) == (y > 0.0) ? k_infinity : 0.0;
}

} // namespace

double pow(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (std::isnan(x) || std::isnan(y)) return x + y;
  if (x == 0.0 || std::isinf(x)) return power_of_extreme(x, y);
  const double size = std::abs(x);
  if (size == 1.0 && (std::isinf(y) || is_integer(y))) return is_odd(y) ? x : 1.0;
  if (std::isinf(y)) return power_to_infinity(x, y);
  if (x < 0.0 && !is_integer(y)) return k_nan;
  double power = 0.0;
  if (std::abs(y) > 0x1p70) {
    power = power_to_infinity(x, y); // no logarithm of a double except that of 1 is below 2⁻⁵³
  } else {
    power = positive_power(size, y);
  }
  return x < 0.0 && is_odd(y) ? -power : power;
}

double log10(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -k_infinity : k_nan;
  if (std::isinf(x)) return x;
  const DoubleDouble result = log_of(x) * k_per_ln10;
  return result.hi + result.lo;
}

} // namespace steplap::portable
