// Finds the frequency with the largest amplitude in a sequence of samples.
#pragma once

#include <span>

namespace steplap {

/// Returns the frequency, Hz, of the maximum of the amplitude spectrum without the mean value, refined by a parabola through three spectral
/// lines. Returns 0 for fewer than eight samples or if all are equal. The resolution is about rate/(number of samples).
[[nodiscard]] double dominant_frequency(std::span<const double> samples, double rate);

} // namespace steplap
