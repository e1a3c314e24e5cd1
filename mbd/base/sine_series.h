// What sine and cosine are made of, on a double or on a pack of them that has the same operators: the same operations in the
// same order, hence the same bits in every lane (sine.cpp; mbd/tape/sine_lanes_of.h).
#pragma once

namespace steplap::portable {

constexpr double k_far = 1e6;                  ///< multiples of π/2 below it fit into 20 bits
constexpr double k_nearest_integer = 0x1.8p52; ///< added and taken away leaves the nearest integer
constexpr double k_two_over_pi = 0x1.45f306dc9c883p-1;
// π/2 in parts of 33 bits, so that each times a multiple is exact, and the rest.
constexpr double k_half_pi[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69, 0x1.b839a252049c1p-104};

template <class Number> struct TwoParts {
  Number hi, lo;
};

/// a + b exactly, as two_sum of double_double.h.
template <class Number> constexpr TwoParts<Number> two_parts(Number a, Number b) {
  const Number s = a + b, b_seen = s - a;
  return {s, (a - (s - b_seen)) + (b - b_seen)};
}

/// x − k π/2 by Cody and Waite, |x| < k_far, k the integer nearest to x 2/π. The first difference is exact (x and k times the
/// first part are within a factor of two), the next are kept with their errors: where x is near a multiple of π/2 they cancel,
/// at most 60 bits.
template <class Number> constexpr TwoParts<Number> beyond_multiple(Number x, Number k) {
  const TwoParts<Number> first = two_parts<Number>(x - k * k_half_pi[0], -k * k_half_pi[1]);
  const TwoParts<Number> second = two_parts<Number>(first.hi, -k * k_half_pi[2]);
  return two_parts<Number>(second.hi, (first.lo + second.lo) - k * k_half_pi[3]);
}

template <class Number> struct SineAndCosine {
  Number sin, cos;
};

/// sin and cos of hi + lo, |hi| ≤ π/4, to x¹⁷ and x¹⁶ (the first terms left out are below 3e-18). Two summands each: the one
/// that carries the digits is exact (hi; 1 − hi²/2 with its error), the other an eighth of it and rounded. In pairs (Estrin),
/// so that the chains stay short.
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
