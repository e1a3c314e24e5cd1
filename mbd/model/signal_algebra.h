// Signals made from signals: sums, products, scaling and delay.
//
// The breakpoints of a result are those of all operands. On each piece the result has again the form polynomial plus harmonics (signal.h),
// so values, derivatives, integrals and jumps remain closed forms. Products of harmonics are expanded: cos a cos b = ½ cos(a+b) + ½
// cos(a−b). A product is refused (std::invalid_argument) if a piece would need more than k_most_terms terms or a power of time above
// k_most_power. Breakpoints that differ only by rounding are merged.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

inline constexpr std::size_t k_most_terms = 10'000; ///< largest number of terms of one piece; a product of a road and a vibration needs
                                                    ///< some thousands
inline constexpr int k_most_power = 20;             ///< largest power of time in one piece; enough for a chirp times a cubic

/// Returns Σ factor · part. `parts` and `factors` must have the same length.
[[nodiscard]] Signal sum_of(const std::vector<const Signal*>& parts, const std::vector<double>& factors);
/// Returns the product of all parts, at least one.
[[nodiscard]] Signal product_of(const std::vector<const Signal*>& parts);
/// Returns factor · signal(t − delay). A signal that is constant from t = 0 on becomes one that begins at t = delay.
[[nodiscard]] Signal delayed(const Signal& signal, double delay, double factor = 1.0);

} // namespace steplap
