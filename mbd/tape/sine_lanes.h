// Sines and cosines of the lanes of a register. Each is compiled for the instructions that it needs: whoever calls it has to
// know that the processor has them.
#pragma once

namespace steplap {

/// sines[l], cosines[l] = portable::sin_cos(x[l]), the same bits, for l up to 2, 4, 8. `x` may be one of the others.
void sin_cos_of_two(const double* x, double* sines, double* cosines);   ///< SSE2
void sin_cos_of_four(const double* x, double* sines, double* cosines);  ///< AVX2
void sin_cos_of_eight(const double* x, double* sines, double* cosines); ///< AVX-512 F and DQ

/// As sin_cos_of_eight, the same bits, on any processor: with the best instructions that it has.
void sin_cos_of_block(const double* x, double* sines, double* cosines);

} // namespace steplap
