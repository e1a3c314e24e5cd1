// Elementary functions whose results are the same bits on every processor and with every C library.
//
// The C library selects routines with or without fused multiply-add at run time, and these differ in the last bit. The functions here use
// only additions, multiplications, divisions and square roots of doubles, which IEEE 754 defines exactly, and are compiled without
// contraction. All code that contributes to results must call them instead of <cmath>; sqrt, abs, floor, fmod, remainder and similar
// functions are exact and may be used. tests/tools/steplap/test_same_bits.cpp finds violations, tests/mbd/test_portable_math.cpp checks the
// errors with 113-bit arithmetic.
//
// Stated errors are in units in the last place (ulp) and include the final rounding of 0.5; for subnormal results they are below 0.8. NaN,
// infinities, zeros and domain errors give the values of Annex F of the C standard, but set no flags and no errno. Precondition: rounding
// to nearest.
#pragma once

namespace steplap::portable {

/// Sine and cosine of one angle.
struct SinCos {
  double sin = 0.0, cos = 1.0;
};

/// Returns sin x and cos x for any finite x, error below 0.8 ulp. Argument reduction by π/2 in four parts of 33 bits (W. J. Cody, W. Waite
/// 1980), for |x| > 10⁶ by the required digits of 2/π (M. Payne, R. Hanek, SIGNUM Newsl. 18 (1983) 19); then Taylor series on [−π/4, π/4].
[[nodiscard]] SinCos sin_cos(double x);
[[nodiscard]] double sin(double x);
[[nodiscard]] double cos(double x);

/// Returns the angle of the point (x, y) in [−π, π], error below 0.6 ulp. Method: atan of the quotient smaller/larger coordinate, as a
/// table value at the nearest multiple of 1/8 plus a Taylor series.
[[nodiscard]] double atan2(double y, double x);

/// Returns √(x² + y²) without intermediate overflow, error below 0.6 ulp; exact if the result is a double.
[[nodiscard]] double hypot(double x, double y);

/// Returns x to the power y, error below 0.6 ulp; exact if the result is a double. Computed as 2^(y log₂ x) with tables of 128 logarithms
/// and 64 powers of two (P. T. P. Tang, ACM Trans. Math. Softw. 15 (1989) 144; 16 (1990) 378); the logarithm is accurate to 67 bits.
[[nodiscard]] double pow(double x, double y);

/// Returns the decimal logarithm, error below 0.6 ulp; exact for powers of ten.
[[nodiscard]] double log10(double x);

} // namespace steplap::portable
