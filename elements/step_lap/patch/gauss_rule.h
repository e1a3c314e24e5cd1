// Gauss-Legendre rules, and a bound by which series and rules are cut off.
#pragma once

#include <cmath>

namespace steplap {

/// Computes nodes on [0, 1] and weights with sum 1; exact for polynomials of degree 2 count − 1.
void gauss_rule(int count, double* x, double* w);

/// Returns k ≥ 0 with x < 2^(−k/4), from the binary exponent of x⁴; 0 if x ≥ 1, or for NaN, which has no exponent. Precondition: x⁴ > 0.
inline int quarter_exponent(double x) { return x < 1.0 ? -1 - std::ilogb(x * x * x * x) : 0; }

} // namespace steplap
