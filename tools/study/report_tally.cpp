#include "tools/study/report_tally.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

constexpr double k_confidence = 0.95;

// Removes values that are not finite.
void sort_out(std::vector<double>& values, Tally& tally) {
  tally.total = static_cast<long>(values.size());
  for (const double x : values) {
    tally.missing += std::isnan(x);
    tally.above += std::isinf(x) && x > 0.0;
    tally.below += std::isinf(x) && x < 0.0;
  }
  std::erase_if(values, [](double x) { return !std::isfinite(x); });
  std::sort(values.begin(), values.end());
}

Curve cumulative_of(const std::vector<double>& sorted, const Tally& tally, bool is_independent, std::size_t most) {
  Curve curve;
  const auto n = static_cast<double>(tally.total), valued = n - static_cast<double>(tally.missing);
  const double half = std::sqrt(std::log(2.0 / (1.0 - k_confidence)) / (2.0 * n));
  for (std::size_t k = 0, count = std::min(most, sorted.size()); k < count; ++k) {
    std::size_t place = count == 1 ? 0 : k * (sorted.size() - 1) / (count - 1);
    while (place + 1 < sorted.size() && sorted[place + 1] == sorted[place]) ++place; // the last of equal values: the upper end of the step
    if (!curve.x.empty() && curve.x.back() == sorted[place]) continue;
    const double reached = static_cast<double>(tally.below) + static_cast<double>(place + 1);
    curve.x.push_back(sorted[place]);
    curve.p.push_back(reached / valued);
    if (!is_independent) continue;
    curve.low.push_back(std::max(0.0, reached / n - half));
    curve.high.push_back(std::min(1.0, (reached + static_cast<double>(tally.missing)) / n + half));
  }
  return curve;
}

// Returns a histogram with the bin width of Freedman and Diaconis.
Histogram histogram_of(const std::vector<double>& sorted, bool is_independent) {
  constexpr double k_fewest = 8.0, k_most = 60.0;
  Histogram histogram;
  if (sorted.empty()) return histogram;
  const std::size_t n = sorted.size();
  const double low = sorted.front(), width = sorted.back() - low;
  const double quartiles = sorted[3 * n / 4] - sorted[n / 4];
  const double bin = 2.0 * quartiles / std::cbrt(static_cast<double>(n));
  const double wanted = bin > 0.0 ? std::ceil(width / bin) : k_fewest;
  const auto bins = width > 0.0 ? static_cast<std::size_t>(std::clamp(wanted, k_fewest, k_most)) : std::size_t{1};
  for (std::size_t i = 0; i <= bins; ++i)
    histogram.edges.push_back(i == bins ? sorted.back() : low + width * static_cast<double>(i) / static_cast<double>(bins));
  histogram.counts.assign(bins, 0);
  for (const double x : sorted) {
    const auto above = std::upper_bound(histogram.edges.begin(), histogram.edges.end(), x) - histogram.edges.begin();
    ++histogram.counts[std::min(bins - 1, static_cast<std::size_t>(std::max<std::ptrdiff_t>(above, 1) - 1))];
  }
  for (std::size_t i = 0; i < bins && is_independent; ++i) {
    const Interval share = proportion_interval(static_cast<double>(histogram.counts[i]), static_cast<double>(n), k_confidence);
    histogram.low.push_back(share.low);
    histogram.high.push_back(share.high);
  }
  return histogram;
}

// Returns true for sample counts at which an estimate is shown: `next`, which then grows by a constant factor, and the last count.
bool is_instant(std::size_t count, std::size_t total, double& next) {
  constexpr double k_growth = 1.07;
  if (count != total && static_cast<double>(count) < next) return false;
  next = std::max(static_cast<double>(count) + 1.0, static_cast<double>(count) * k_growth);
  return true;
}

} // namespace

Tally tally_of(std::vector<double> values, bool is_independent, std::size_t most) {
  Tally tally;
  sort_out(values, tally);
  double sum = 0.0;
  for (const double x : values) sum += x;
  tally.mean = values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
  tally.cumulative = cumulative_of(values, tally, is_independent, most);
  tally.histogram = histogram_of(values, is_independent);
  return tally;
}

Running running_mean(const std::vector<double>& values) {
  Running running;
  double mean = 0.0, squares = 0.0, next = 10.0;
  long count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      const double difference = values[i] - mean;
      mean += difference / static_cast<double>(++count);
      squares += difference * (values[i] - mean);
    }
    if (count < 2 || !is_instant(i + 1, values.size(), next)) continue;
    const double free = static_cast<double>(count) - 1.0;
    const double half = student_quantile(free, 0.5 * (1.0 + k_confidence)) * std::sqrt(squares / free / static_cast<double>(count));
    running.samples.push_back(static_cast<double>(i + 1));
    running.value.push_back(mean);
    running.low.push_back(mean - half);
    running.high.push_back(mean + half);
  }
  return running;
}

Running running_share(const std::vector<char>& sure, const std::vector<char>& possible) {
  Running running;
  double least = 0.0, most = 0.0, next = 10.0;
  for (std::size_t i = 0; i < sure.size(); ++i) {
    least += sure[i];
    most += possible[i];
    if (!is_instant(i + 1, sure.size(), next)) continue;
    const auto n = static_cast<double>(i + 1);
    running.samples.push_back(n);
    running.value.push_back(most / n);
    running.low.push_back(proportion_interval(least, n, k_confidence).low);
    running.high.push_back(proportion_interval(most, n, k_confidence).high);
  }
  return running;
}

} // namespace steplap::study
