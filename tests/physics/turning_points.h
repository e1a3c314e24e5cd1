// Oscillation of a sampled series.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace steplap::testing {

/// Number of local extremes of a series within [from, to], each followed by a change of more than `least` in the other direction.
inline int turning_points(const std::vector<double>& series, std::size_t from, std::size_t to, double least) {
  double low = series[from], high = series[from];
  int count = 0, direction = 0;
  for (std::size_t i = from + 1; i <= to; ++i) {
    low = std::min(low, series[i]);
    high = std::max(high, series[i]);
    const bool falls = direction >= 0 && high - series[i] > least, rises = direction <= 0 && series[i] - low > least;
    if (!falls && !rises) continue;
    if (direction != 0) ++count;
    direction = falls ? -1 : 1;
    low = high = series[i];
  }
  return count;
}

} // namespace steplap::testing
