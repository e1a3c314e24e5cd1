// Mean of independent values ≥ 0 with a confidence interval for skewed distributions.
//
// Importance weights of failing samples and probabilities along rays are skewed: most are small or zero, a few are large, and Student's
// interval is biased low. Hall's transformation removes the skewness (P. Hall, On the removal of skewness by transformation, J. R. Statist.
// Soc. B 54, 1992). For n values with mean m, standard deviation s and skewness k, and W = (m - mu)/s,
//
//   T = W + k W²/3 + k² W³/27 + k/(6 n)
//
// is normal with variance 1/n up to terms of order 1/n. It is inverted in closed form.
#pragma once

#include "tools/study/law.h"

namespace steplap::study {

/// Accumulates the values.
class WeightedMean {
public:
  void add(double w);
  void add_zeros(long count) { count_ += count; }

  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] long hits() const { return hits_; } ///< number of values above zero
  [[nodiscard]] double mean() const;
  /// Returns the standard deviation of the mean; infinite as long as fewer than two values are above zero.
  [[nodiscard]] double deviation() const;
  /// Returns the number of equal values that would say as much, (Σ w)²/Σ w² (Kish).
  [[nodiscard]] double effective() const { return squares_ > 0.0 ? sum_ * sum_ / squares_ : 0.0; }
  /// Returns the largest value divided by the sum.
  [[nodiscard]] double largest_share() const;
  /// Returns the confidence interval within [0, 1]; [0, 1] as long as fewer than two values are above zero.
  [[nodiscard]] Interval interval(double confidence) const;

private:
  double sum_ = 0.0, squares_ = 0.0, cubes_ = 0.0, largest_ = 0.0;
  long count_ = 0, hits_ = 0;
};

} // namespace steplap::study
