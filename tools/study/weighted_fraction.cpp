#include "tools/study/weighted_fraction.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

void WeightedFraction::add(double w, bool is_hit) {
  hits_.add(is_hit ? w : 0.0);
  sum_ += w;
  squares_ += w * w;
  if (!is_hit) return;
  hit_sum_ += w;
  hit_squares_ += w * w;
}

double WeightedFraction::mean() const { return sum_ > 0.0 ? hit_sum_ / sum_ : 0.0; }

double WeightedFraction::deviation() const {
  if (hits_.hits() < 2) return std::numeric_limits<double>::infinity();
  const double p = mean();
  return std::sqrt(std::max(0.0, hit_squares_ * (1.0 - 2.0 * p) + p * p * squares_)) / sum_;
}

Interval WeightedFraction::interval(double confidence) const {
  if (hits_.hits() < 2) return {0.0, 1.0};
  const double p = mean(), weight = sum_ / static_cast<double>(hits_.count()), of_hits = hits_.deviation();
  const double stretch = of_hits > 0.0 ? deviation() / of_hits : 1.0 / weight;
  const Interval interval = hits_.interval(confidence);
  return {std::clamp(p - stretch * (hits_.mean() - interval.low), 0.0, 1.0),
          std::clamp(p + stretch * (interval.high - hits_.mean()), 0.0, 1.0)};
}

double WeightedFraction::effective() const { return squares_ > 0.0 ? sum_ * sum_ / squares_ : 0.0; }

double WeightedFraction::effective_hits() const { return hits_.effective(); }

} // namespace steplap::study
