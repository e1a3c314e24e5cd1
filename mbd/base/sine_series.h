// Argument reduction and series of sine and cosine, as templates over double or a SIMD pack of doubles. The operations and their order are
// the same for both, so every lane has the bits of the scalar function (sine.cpp; mbd/tape/sine_lanes_of.h).
#pragma once

namespace steplap::portable {

constexpr double k_far = 1e6;                  ///< limit of Cody–Waite reduction: multiples of π/2 below it fit into 20 bits
constexpr double k_nearest_integer = 0x1.8p52; ///< adding and subtracting it rounds to the nearest integer
constexpr double k_two_over_pi = 0x1.45f306dc9c883p-1;
// π/2 as a sum of three parts of at most 33 bits, whose products with a multiple k are exact, and a remainder.
constexpr double k_half_pi[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69, 0x1.b839a252049c1p-104};

template <class Number> struct TwoParts {
  Number hi, lo;
};

/// Returns a + b exactly, as two_sum() of double_double.h.
template <class Number> constexpr TwoParts<Number> two_parts(Number a, Number b) {
  const Number s = a + b, b_seen = s - a;
  return {s, (a - (s - b_seen)) + (b - b_seen)};
}

/// Returns x − k π/2 for the integer k nearest to 2x/π (Cody and Waite). Precondition: |x| < k_far. The first difference is exact, because
/// x and k times the first part are within a factor of two. The rounding errors of the other differences are kept, because up to 60 bits
/// cancel near a multiple of π/2.
template <class Number> constexpr TwoParts<Number> beyond_multiple(Number x, Number k) {
  const TwoParts<Number> first = two_parts<Number>(x - k * k_half_pi[0], -k * k_half_pi[1]);
  const TwoParts<Number> second = two_parts<Number>(first.hi, -k * k_half_pi[2]);
  return two_parts<Number>(second.hi, (first.lo + second.lo) - k * k_half_pi[3]);
}

template <class Number> struct SineAndCosine {
  Number sin, cos;
};

/// Returns sin and cos of hi + lo, |hi| ≤ π/4, by Taylor series up to x¹⁷ and x¹⁶; the first omitted terms are below 3e-18. Each result is
/// an exact leading part (hi; 1 − hi²/2 with its rounding error) plus a rounded remainder of at most an eighth of it. The series are
/// evaluated in pairs (Estrin's scheme) to shorten dependency chains.
template <class Number> constexpr SineAndCosine<Number> sine_series(Number hi, Number lo) {
  const Number z = hi * hi, z2 = z * z, z4 = z2 * z2;
  const Number s = ((-1.0 / 6 + z * (1.0 / 120)) + z2 * (-1.0 / 5040 + z * (1.0 / 362880))) +
                   z4 * ((-1.0 / 39916800 + z * (1.0 / 6227020800.0)) + z2 * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)));
  const Number c = ((1.0 / 24 - z * (1.0 / 720)) + z2 * (1.0 / 40320 - z * (1.0 / 3628800))) +
                   z4 * ((1.0 / 479001600 - z * (1.0 / 87178291200.0)) + z2 * (1.0 / 20922789888000.0));
  const Number half = 0.5 * z, most = 1.0 - half;
  return {hi + (hi * z * s + lo * most), most + (((1.0 - most) - half) + (z2 * c - hi * lo))};
}

} // namespace steplap::portable
