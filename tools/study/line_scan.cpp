#include "tools/study/line_scan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace steplap::study {

namespace {

// Returns the indices of samples with a local minimum of |g| and no sign change, smallest |g| first: the function may touch zero or cross
// it twice there.
std::vector<std::size_t> turns_of(const LineSamples& samples) {
  constexpr std::size_t k_most = 6;
  std::vector<std::size_t> turns;
  for (std::size_t i = 1; i + 1 < samples.x.size(); ++i) {
    const double before = samples.g[i - 1], here = samples.g[i], after = samples.g[i + 1];
    const bool is_one_side = before * after > 0.0 && here * before >= 0.0;
    if (is_one_side && std::abs(here) < std::abs(before) && std::abs(here) < std::abs(after)) turns.push_back(i);
  }
  std::stable_sort(turns.begin(), turns.end(),
                   [&](std::size_t l, std::size_t r) { return std::abs(samples.g[l]) < std::abs(samples.g[r]); });
  if (turns.size() > k_most) turns.resize(k_most);
  return turns;
}

} // namespace

std::vector<double> evenly_spaced(double low, double high, long points) {
  std::vector<double> xs;
  for (long k = 0; k + 1 < points; ++k) xs.push_back(low + (high - low) * static_cast<double>(k) / static_cast<double>(points - 1));
  xs.push_back(high);
  return xs;
}

void add_samples(const LineFunction& function, std::vector<double> more, LineSamples& samples) {
  std::sort(more.begin(), more.end());
  more.erase(std::unique(more.begin(), more.end()), more.end());
  const std::vector<double> values = function(more);
  std::vector<std::pair<double, double>> all;
  for (std::size_t i = 0; i < samples.x.size(); ++i) all.emplace_back(samples.x[i], samples.g[i]);
  for (std::size_t i = 0; i < more.size(); ++i) all.emplace_back(more[i], values[i]);
  std::sort(all.begin(), all.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
  samples = {};
  for (const auto& [x, g] : all) samples.x.push_back(x), samples.g.push_back(g);
}

void refine_turns(const LineFunction& function, LineSamples& samples) {
  constexpr int k_rounds = 4, k_parts = 8;
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<double> more;
    for (const std::size_t i : turns_of(samples))
      for (int k = 1; k < k_parts; ++k)
        for (const std::size_t from : {i - 1, i}) more.push_back(samples.x[from] + (samples.x[from + 1] - samples.x[from]) * k / k_parts);
    if (more.empty()) return;
    add_samples(function, std::move(more), samples);
  }
}

} // namespace steplap::study
