// The frequency at which a stretch of samples has most of its motion.
#pragma once

#include <span>

namespace steplap {

/// Hz, where the amplitude spectrum of the samples without their mean is greatest; between its lines by the parabola through three of
/// them. 0 for fewer than eight samples, or if all are equal. Resolves about rate/(number of samples).
[[nodiscard]] double dominant_frequency(std::span<const double> samples, double rate);

} // namespace steplap
