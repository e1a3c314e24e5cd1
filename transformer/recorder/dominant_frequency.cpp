#include "transformer/recorder/dominant_frequency.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace steplap {

namespace {

constexpr double k_level = 0.1; // level of a swing, relative to the largest magnitude; values below may be noise
constexpr double k_large = 0.5; // least peak of a swing that counts, relative to the largest magnitude

// A swing: consecutive samples beyond the level on one side of zero. Begin and end are in samples, where the linearly interpolated signal
// crosses the level.
struct HalfCycle {
  double begin = 0.0, end = 0.0;
  double peak = 0.0; ///< peak with its sign
};

std::vector<HalfCycle> swings_beyond(double level, std::span<const double> samples) {
  std::vector<HalfCycle> swings;
  const auto is_beyond = [&](std::size_t i, double sign) { return sign * samples[i] > level; };
  for (std::size_t i = 0; i < samples.size();) {
    const double sign = samples[i] < 0.0 ? -1.0 : 1.0;
    if (!is_beyond(i, sign)) {
      ++i;
      continue;
    }
    // Returns the distance, in samples, from sample `inside` to the crossing of the level.
    const auto crossing = [&](std::size_t inside, std::size_t outside) {
      return (sign * samples[inside] - level) / (sign * (samples[inside] - samples[outside]));
    };
    HalfCycle swing;
    swing.begin = static_cast<double>(i) - (i > 0 ? crossing(i, i - 1) : 0.0);
    for (; i < samples.size() && is_beyond(i, sign); ++i)
      if (std::abs(samples[i]) > std::abs(swing.peak)) swing.peak = samples[i];
    swing.end = static_cast<double>(i - 1) + (i < samples.size() ? crossing(i - 1, i) : 0.0);
    swings.push_back(swing);
  }
  return swings;
}

} // namespace

double dominant_frequency(std::span<const double> samples, double rate) {
  double largest = 0.0;
  for (const double sample : samples) largest = std::max(largest, std::abs(sample));
  if (!(largest > 0.0)) return 0.0;
  const double level = k_level * largest;
  const std::vector<HalfCycle> swings = swings_beyond(level, samples);
  const auto by_peak = [](const HalfCycle& a, const HalfCycle& b) { return std::abs(a.peak) < std::abs(b.peak); };
  auto first = std::max_element(swings.begin(), swings.end(), by_peak), last = first;
  const auto continues = [&](const HalfCycle& a, const HalfCycle& b) {
    const double shorter = std::min(a.end - a.begin, b.end - b.begin);
    return a.peak * b.peak < 0.0 && b.begin - a.end < k_large * shorter &&
           std::min(std::abs(a.peak), std::abs(b.peak)) >= k_large * largest;
  };
  while (first != swings.begin() && continues(*(first - 1), *first)) --first;
  while (last + 1 != swings.end() && continues(*last, *(last + 1))) ++last;
  // Returns the part of a half period at each end of a swing in which a sine with this peak is below the level: asin(level/peak)/π.
  const auto below = [&](const HalfCycle& swing) {
    const double share = level / std::abs(swing.peak);
    return portable::atan2(share, std::sqrt(1.0 - share * share)) / std::numbers::pi;
  };
  const double half_periods = static_cast<double>(last - first + 1) - below(*first) - below(*last);
  return half_periods * rate / (2.0 * (last->end - first->begin));
}

} // namespace steplap
