#include "tools/pages/thinning.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap {

std::vector<std::size_t> thinned(const std::vector<double>& values, std::size_t stretches) {
  const std::size_t n = values.size();
  std::vector<std::size_t> kept;
  if (n <= 2 * stretches + 2) {
    kept.resize(n);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  kept.push_back(0);
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = k * n / stretches, end = (k + 1) * n / stretches;
    std::size_t low = end, high = end, gap = end;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isnan(values[i])) gap = std::min(gap, i);
      else {
        if (low == end || values[i] < values[low]) low = i;
        if (high == end || values[i] > values[high]) high = i;
      }
    }
    for (const std::size_t i : {low, high, gap})
      if (i != end) kept.push_back(i);
  }
  kept.push_back(n - 1);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

} // namespace steplap
