// Fraction of weighted samples that fail, with a confidence interval.
//
// The estimate is p = Σ w f/Σ w with f = 0 or 1. Its variance, to first order in the scatter of both sums, is Σ w² (f − p)²/(Σ w)². The
// interval is Hall's interval for the mean of w f (weighted_mean.h), which takes the skewness of rare failures into account, widened by the
// ratio of the deviations of p and of that mean, because Σ w scatters, too.
#pragma once

#include "tools/study/weighted_mean.h"

namespace steplap::study {

/// Accumulates the samples.
class WeightedFraction {
public:
  /// Adds a sample with a weight w from 0 to 1.
  void add(double w, bool is_hit);

  /// Returns the estimate p; zero without samples.
  [[nodiscard]] double mean() const;
  /// Returns the standard deviation of the mean; infinite as long as fewer than two samples are hits.
  [[nodiscard]] double deviation() const;
  /// Returns the confidence interval within [0, 1]; [0, 1] as long as fewer than two samples are hits.
  [[nodiscard]] Interval interval(double confidence) const;
  /// Returns the effective number of samples, (Σ w)²/Σ w² (Kish): of all samples, and of the hits.
  [[nodiscard]] double effective() const;
  [[nodiscard]] double effective_hits() const;

private:
  WeightedMean hits_;
  double sum_ = 0.0, squares_ = 0.0, hit_sum_ = 0.0, hit_squares_ = 0.0;
};

} // namespace steplap::study
