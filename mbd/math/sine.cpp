#include "mbd/math/portable_math.h"

#include "mbd/math/double_double.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace steplap::portable {

namespace {

__extension__ using Wide = unsigned __int128;

/// What is left of x beyond the nearest multiple of π/2, |hi| ≤ π/4, and that multiple (mod 4 it
/// counts).
struct Remainder {
  double hi, lo;
  unsigned quarter;
};

constexpr double k_quarter_pi = 0.78539816339744828;
constexpr double k_far = 1e6; // multiples of π/2 below it fit into 20 bits

// π/2 in parts of 33 bits, so that each times a multiple is exact, and the rest.
constexpr double k_half_pi[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                                 0x1.b839a252049c1p-104};
constexpr DoubleDouble k_half_pi_sum{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double k_two_over_pi = 0x1.45f306dc9c883p-1;

// x − k π/2 by Cody and Waite. The first difference is exact (x and k times the first part are
// within a factor of two), the next are kept with their errors: where x is near a multiple of π/2
// they cancel, at most 60 bits.
Remainder reduce(double x) {
  constexpr double round = 0x1.8p52; // added and taken away leaves the nearest integer
  const double k = (x * k_two_over_pi + round) - round;
  const DoubleDouble first = two_sum(x - k * k_half_pi[0], -k * k_half_pi[1]);
  const DoubleDouble second = two_sum(first.hi, -k * k_half_pi[2]);
  const DoubleDouble rest = two_sum(second.hi, (first.lo + second.lo) - k * k_half_pi[3]);
  return {rest.hi, rest.lo, static_cast<unsigned>(static_cast<int>(k))};
}

// 2/π = 0.101000101…b behind 64 zeros, 1344 bits.
constexpr std::uint64_t k_two_over_pi_bits[22] = {
    0x0000000000000000, 0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041,
    0xfe5163abdebbc561, 0xb7246e3a424dd2e0, 0x06492eea09d1921c, 0xfe1deb1cb129a73e,
    0xe88235f52ebb4484, 0xe99c7026b45f7e41, 0x3991d639835339f4, 0x9c845f8bbdf9283b,
    0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab,
    0xf0cfbc209af4361d, 0xa9e391615ee61b08};

// 64 of these bits from the one of the given number on.
std::uint64_t bits_from(int first) {
  const int word = first / 64, shift = first % 64;
  const std::uint64_t* w = k_two_over_pi_bits + word;
  return shift == 0 ? w[0] : (w[0] << shift) | (w[1] >> (64 - shift));
}

// f 2⁻¹²⁸ as a sum of two doubles; the topmost 64 bits of f are not all zero.
DoubleDouble fraction_of(Wide f) {
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(f >> 64));
  const Wide aligned = f << zeros;
  const auto high = static_cast<double>(static_cast<std::uint64_t>(aligned >> 75));
  const auto low =
      static_cast<double>(static_cast<std::uint64_t>(aligned >> 22) & 0x1fffffffffffff);
  return {std::ldexp(high, -53 - zeros), std::ldexp(low, -106 - zeros)};
}

// x = m 2^e, m an integer. Digits of 2/π that make multiples of four of the product fall away, the
// next 192 count: x 2/π mod 4 is then known to 2⁻¹³⁶, and no double comes nearer to a multiple of
// π/2 than 2⁻⁶².
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
  if (is_past_half) ++quarter; // and 1 − f away from it
  const bool is_negative = is_past_half != (x < 0.0);
  const DoubleDouble r = fraction_of(is_past_half ? Wide{0} - f : f) * k_half_pi_sum;
  return {is_negative ? -r.hi : r.hi, is_negative ? -r.lo : r.lo, x < 0.0 ? 0u - quarter : quarter};
}

// sin and cos of hi + lo, |hi| ≤ π/4, to x¹⁷ and x¹⁶ (the first terms left out are below 3e-18).
// Two summands each: the one that carries the digits is exact (hi; 1 − hi²/2 with its error), the
// other an eighth of it and rounded. In pairs (Estrin), so that the chains stay short.
SinCos series(double hi, double lo) {
  const double z = hi * hi, z2 = z * z, z4 = z2 * z2;
  const double s = ((-1.0 / 6 + z * (1.0 / 120)) + z2 * (-1.0 / 5040 + z * (1.0 / 362880))) +
                   z4 * ((-1.0 / 39916800 + z * (1.0 / 6227020800.0)) +
                         z2 * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)));
  const double c =
      ((1.0 / 24 - z * (1.0 / 720)) + z2 * (1.0 / 40320 - z * (1.0 / 3628800))) +
      z4 * ((1.0 / 479001600 - z * (1.0 / 87178291200.0)) + z2 * (1.0 / 20922789888000.0));
  const double half = 0.5 * z, most = 1.0 - half;
  return {hi + (hi * z * s + lo * most), most + (((1.0 - most) - half) + (z2 * c - hi * lo))};
}

Remainder remainder_of(double x) {
  return std::abs(x) < k_far ? reduce(x)
         : std::isfinite(x)  ? reduce_far(x)
                             : Remainder{x - x, 0.0, 0};
}

} // namespace

SinCos sin_cos(double x) {
  if (std::abs(x) <= k_quarter_pi) {
    if (std::abs(x) < 0x1p-28) return {x, 1.0}; // and −0 stays −0
    return series(x, 0.0);
  }
  const Remainder r = remainder_of(x);
  const SinCos of = series(r.hi, r.lo);
  const double s = r.quarter & 1 ? of.cos : of.sin, c = r.quarter & 1 ? of.sin : of.cos;
  return {r.quarter & 2 ? -s : s, (r.quarter + 1) & 2 ? -c : c};
}

double sin(double x) {
  return sin_cos(x).sin;
}
double cos(double x) {
  return sin_cos(x).cos;
}

} // namespace steplap::portable
