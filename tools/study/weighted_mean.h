// The mean of independent values from zero up, and an interval for it.
//
// Weights of samples that fail, and probabilities along rays, are skewed: most are small or zero, a few are large.
// Student's interval of such values lies too low. Hall's transformation takes the skewness out (P. Hall, On the removal
// of skewness by transformation, J. R. Statist. Soc. B 54, 1992): of n values with the mean m, the standard deviation s
// and the skewness k, with W = (m - mu)/s,
//   T = W + k W²/3 + k² W³/27 + k/(6 n)
// is normal with the variance 1/n up to the order 1/n. It is inverted in closed form.
#pragma once

#include "tools/study/law.h"

namespace steplap::study {

class WeightedMean {
public:
  void add(double w);

  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] long hits() const { return hits_; } ///< values above zero
  [[nodiscard]] double mean() const;
  /// Standard deviation of the mean; infinite while fewer than two values are above zero.
  [[nodiscard]] double deviation() const;
  /// Share of the largest value in the sum.
  [[nodiscard]] double largest_share() const;
  /// Within [0, 1], all of it while fewer than two values are above zero.
  [[nodiscard]] Interval interval(double confidence) const;

private:
  double sum_ = 0.0, squares_ = 0.0, cubes_ = 0.0, largest_ = 0.0;
  long count_ = 0, hits_ = 0;
};

} // namespace steplap::study
