// Signals made of signals: sums, products, and one scaled and delayed.
//
// All of them are pieces of the same family again, polynomials and powers of time times harmonics, between the
// breakpoints of all that they are made of: values, derivatives, integrals, jumps and kinks stay closed forms. A product
// of harmonics has the sum and the difference of their frequencies: cos a cos b = ½ cos(a+b) + ½ cos(a−b).
// Limits: a product whose pieces would have more than k_most_terms terms, or a power of time above k_most_power, is
// refused (std::invalid_argument). Breakpoints that differ by rounding only become one.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

inline constexpr std::size_t k_most_terms = 10'000; ///< of one piece: a road and a vibration that grow have some thousands
inline constexpr int k_most_power = 20;             ///< of time, in one piece: of a chirp times a cubic, and one more

/// Σ factor · part; as many factors as parts.
[[nodiscard]] Signal sum_of(const std::vector<const Signal*>& parts, const std::vector<double>& factors);
/// Π part, at least one.
[[nodiscard]] Signal product_of(const std::vector<const Signal*>& parts);
/// The same history, later by `delay` and times `factor`: a constant then begins at t = delay.
[[nodiscard]] Signal delayed(const Signal& signal, double delay, double factor = 1.0);

} // namespace steplap
