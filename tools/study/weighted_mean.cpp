#include "tools/study/weighted_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap::study {

void WeightedMean::add(double w) {
  ++count_;
  if (w <= 0.0) return;
  ++hits_;
  sum_ += w;
  squares_ += w * w;
  cubes_ += w * w * w;
  largest_ = std::max(largest_, w);
}

double WeightedMean::mean() const { return count_ ? sum_ / static_cast<double>(count_) : 0.0; }

double WeightedMean::deviation() const {
  if (hits_ < 2) return std::numeric_limits<double>::infinity();
  const double n = static_cast<double>(count_), m = mean();
  return std::sqrt(std::max(0.0, squares_ / n - m * m) / (n - 1.0));
}

double WeightedMean::largest_share() const { return sum_ > 0.0 ? largest_ / sum_ : 0.0; }

Interval WeightedMean::interval(double confidence) const {
  if (hits_ < 2) return {0.0, 1.0};
  const double n = static_cast<double>(count_), m = mean(), variance = std::max(0.0, squares_ / n - m * m);
  const double s = std::sqrt(variance * n / (n - 1.0));
  if (!(s > 0.0)) return {std::min(m, 1.0), std::min(m, 1.0)};
  const double third = cubes_ / n - 3.0 * m * squares_ / n + 2.0 * m * m * m;
  const double skewness = third / (variance * std::sqrt(variance));
  const double y = student_quantile(static_cast<double>(hits_ - 1), 0.5 * (1.0 + confidence)) / std::sqrt(n);
  // T is a shifted cube of W, T − k/(6 n) = ((1 + k W/3)³ − 1)/k, and can therefore be inverted in closed form.
  const auto inverse = [&](double t) {
    const double x = skewness * (t - skewness / (6.0 * n));
    return std::abs(skewness) * y > 1e-6 ? 3.0 * (std::cbrt(1.0 + x) - 1.0) / skewness : t;
  };
  return {std::clamp(m - s * inverse(y), 0.0, 1.0), std::clamp(m - s * inverse(-y), 0.0, 1.0)};
}

} // namespace steplap::study
