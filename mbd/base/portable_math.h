// Functions whose bits depend on nothing but their argument: not on the processor, not on the
// version of the C library.
//
// The C library chooses at run time among routines with and without fused multiplication, and these
// differ in the last bit. Here are additions, products, quotients and square roots of doubles only,
// each of which IEEE 754 defines to the bit; compiled without contraction. Everything that enters a
// result calls these instead of <cmath> (sqrt, abs, floor, fmod, remainder and the like are exact and
// stay): tests/tools/steplap/test_same_bits.cpp looks for others, tests/mbd/test_portable_math.cpp compares
// with 113-bit arithmetic.
//
// Errors are in units in the last place of the result, rounding of the result (0.5) included; below
// 0.8 where the result is subnormal. Arguments that are NaN, infinite or zero, or where there is no
// value, give what C's Annex F asks for; no flags, no errno. Rounding must be to nearest.
#pragma once

namespace steplap::portable {

struct SinCos {
  double sin = 0.0, cos = 1.0;
};

/// sin x and cos x for any finite x, error below 0.8. x is reduced by multiples of π/2 in four
/// parts of 33 bits (W. J. Cody, W. Waite 1980), beyond 10⁶ by the digits of 2/π that matter (M.
/// Payne, R. Hanek, SIGNUM Newsl. 18 (1983) 19); then Taylor series on [−π/4, π/4].
[[nodiscard]] SinCos sin_cos(double x);
[[nodiscard]] double sin(double x);
[[nodiscard]] double cos(double x);

/// Angle of the point (x, y) in [−π, π], error below 0.6. The quotient of the smaller to the larger
/// is turned back by the angle whose tangent is the nearest eighth, the rest is Taylor's series.
[[nodiscard]] double atan2(double y, double x);

/// √(x² + y²) without overflow in between, error below 0.6; exact where the result is a double.
[[nodiscard]] double hypot(double x, double y);

/// x to the power y, error below 0.6; exact where the result is a double. 2^(y log₂ x) by tables of
/// 128 logarithms and 64 powers of two (P. T. P. Tang, ACM Trans. Math. Softw. 15 (1989) 144; 16
/// (1990) 378), the logarithm to 67 bits.
[[nodiscard]] double pow(double x, double y);

/// Decimal logarithm, error below 0.6; exact for powers of ten.
[[nodiscard]] double log10(double x);

} // namespace steplap::portable
