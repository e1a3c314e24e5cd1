// Gauss-Legendre rules.
#pragma once

namespace steplap {

/// Computes nodes on [0, 1] and weights with sum 1; exact for polynomials of degree 2 count − 1.
void gauss_rule(int count, double* x, double* w);

} // namespace steplap
