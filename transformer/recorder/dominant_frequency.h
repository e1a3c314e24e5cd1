// Finds the frequency of the largest swings in a sequence of samples.
#pragma once

#include <span>

namespace steplap {

/// Returns the frequency, Hz, of the swings around the sample with the largest magnitude, whatever silence surrounds them. A swing lasts
/// half a period, so a half sine of duration T has the frequency 1/(2T). The swings that count follow each other with alternating signs and
/// reach half the largest magnitude. Exact for sines, except for the sampling. Returns 0 if all samples are zero.
[[nodiscard]] double dominant_frequency(std::span<const double> samples, double rate);

} // namespace steplap
