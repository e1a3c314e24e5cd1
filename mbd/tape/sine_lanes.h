// Sines and cosines of several numbers at once by SIMD instructions. Each function is compiled for its instruction set; the caller must
// know that the processor has it.
#pragma once

namespace steplap {

/// Computes sines[l], cosines[l] = portable::sin_cos(x[l]), bit-identical, for 2, 4 or 8 lanes l. `x` may be the same array as an output.
void sin_cos_of_two(const double* x, double* sines, double* cosines);   ///< SSE2
void sin_cos_of_four(const double* x, double* sines, double* cosines);  ///< AVX2
void sin_cos_of_eight(const double* x, double* sines, double* cosines); ///< AVX-512 F and DQ

/// Computes sines[l], cosines[l] = portable::sin_cos(x[l]) for 8 lanes, bit-identical, by the best instructions of the processor at hand.
void sin_cos_of_block(const double* x, double* sines, double* cosines);

} // namespace steplap
