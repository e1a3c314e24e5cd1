#include "mbd/base/portable_math.h"

#include "mbd/base/double_double.h"
#include "mbd/base/sine_series.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace steplap::portable {

namespace {

__extension__ using Wide = unsigned __int128;

/// Result of argument reduction: x = (hi + lo) + quarter · π/2 with |hi| ≤ π/4. Only `quarter` mod 4 matters.
struct Remainder {
  double hi, lo;
  unsigned quarter;
};

constexpr double k_quarter_pi = 0.78539816339744828;
constexpr DoubleDouble k_half_pi_sum{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

Remainder reduce(double x) {
  const double k = (x * k_two_over_pi + k_nearest_integer) - k_nearest_integer;
  const TwoParts<double> rest = beyond_multiple(x, k);
  return {rest.hi, rest.lo, static_cast<unsigned>(static_cast<int>(k))};
}

// Binary digits of 2/π: 64 zero bits, then the first 1344 bits of 0.101000101….
constexpr std::uint64_t k_two_over_pi_bits[22] = {
    0x0000000000000000, 0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561, 0xb7246e3a424dd2e0,
    0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41, 0x3991d639835339f4, 0x9c845f8bbdf9283b,
    0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d, 0x7527bac7ebe5f17b, 0x3d0739f78a5292ea,
    0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab, 0xf0cfbc209af4361d, 0xa9e391615ee61b08};

// Returns 64 bits of k_two_over_pi_bits, beginning with bit number `first`.
std::uint64_t bits_from(int first) {
  const int word = first / 64, shift = first % 64;
  const std::uint64_t* w = k_two_over_pi_bits + word;
  return shift == 0 ? w[0] : (w[0] << shift) | (w[1] >> (64 - shift));
}

// Returns f 2⁻¹²⁸ as a sum of two doubles. Precondition: the upper 64 bits of f are not all zero.
DoubleDouble fraction_of(Wide f) {
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(f >> 64));
  const Wide aligned = f << zeros;
  const auto high = static_cast<double>(static_cast<std::uint64_t>(aligned >> 75));
  const auto low = static_cast<double>(static_cast<std::uint64_t>(aligned >> 22) & 0x1fffffffffffff);
  return {std::ldexp(high, -53 - zeros), std::ldexp(low, -106 - zeros)};
}

// Payne–Hanek reduction of x = m 2^e, m an integer. Leading digits of 2/π that contribute multiples of four to the product are skipped; the
// next 192 bits give x 2/π mod 4 to 2⁻¹³⁶. This suffices, since no double is nearer to a multiple of π/2 than 2⁻⁶².
Remainder reduce_far(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(std::abs(x));
  const int e = static_cast<int>(bits >> 52) - 1075;
  const std::uint64_t m = (bits & 0xfffffffffffff) | 0x10000000000000;
  std::uint64_t product[3], carry = 0;
  for (int i = 2; i >= 0; --i) {
    const Wide p = static_cast<Wide>(m) * bits_from(62 + e + 64 * i) + carry;
    product[i] = static_cast<std::uint64_t>(p);
    carry = static_cast<std::uint64_t>(p >> 64);
  }
  auto quarter = static_cast<unsigned>(product[0] >> 62);
  const Wide upper = static_cast<Wide>(product[0]) << 64 | product[1];
  const Wide f = upper << 2 | product[2] >> 62;
  const bool is_past_half = f >> 127 != 0;
  if (is_past_half) ++quarter; // the remainder is then −(1 − f) quarters
  const bool is_negative = is_past_half != (x < 0.0);
  const DoubleDouble r = fraction_of(is_past_half ? Wide{0} - f : f) * k_half_pi_sum;
  return {is_negative ? -r.hi : r.hi, is_negative ? -r.lo : r.lo, x < 0.0 ? 0u - quarter : quarter};
}

SinCos series(double hi, double lo) {
  const SineAndCosine<double> of = sine_series(hi, lo);
  return {of.sin, of.cos};
}

Remainder remainder_of(double x) { return std::abs(x) < k_far ? reduce(x) : std::isfinite(x) ? reduce_far(x) : Remainder{x - x, 0.0, 0}; }

} // namespace

SinCos sin_cos(double x) {
  if (std::abs(x) <= k_quarter_pi) {
    if (std::abs(x) < 0x1p-28) return {x, 1.0}; // keeps −0
    return series(x, 0.0);
  }
  const Remainder r = remainder_of(x);
  const SinCos of = series(r.hi, r.lo);
  const double s = r.quarter & 1 ? of.cos : of.sin, c = r.quarter & 1 ? of.sin : of.cos;
  return {r.quarter & 2 ? -s : s, (r.quarter + 1) & 2 ? -c : c};
}

double sin(double x) { return sin_cos(x).sin; }
double cos(double x) { return sin_cos(x).cos; }

} // namespace steplap::portable
