// Statistics of samples for a page: distribution of values, and convergence of a mean.
//
// All samples are included, even if the page shows fewer. Bands and intervals have 95 % confidence and are given only for samples drawn
// independently.
#pragma once

#include "tools/study/law.h"

#include <vector>

namespace steplap::study {

/// Selected steps of an empirical distribution function: fraction p of values up to x, with a confidence band.
struct Curve {
  std::vector<double> x, p, low, high;
};

/// Histogram: `counts` of values between neighbouring `edges`, with confidence intervals of the fractions.
struct Histogram {
  std::vector<double> edges;
  std::vector<long> counts;
  std::vector<double> low, high;
};

/// Statistics of one column of samples.
struct Tally {
  long total = 0, missing = 0; ///< total number of runs; number of runs without a value
  long above = 0, below = 0;   ///< number of values that are +∞ and −∞
  double mean = 0.0;           ///< mean of the finite values
  Curve cumulative;            ///< distribution of the finite values; its fractions include the infinite ones
  Histogram histogram;         ///< histogram of the finite values
};

/// Computes the statistics. The band is that of Dvoretzky, Kiefer and Wolfowitz with Massart's constant: it contains the whole distribution
/// function with 95 % confidence. Runs without a value (NaN) widen it on both sides. At most `most` steps are kept, evenly in p.
[[nodiscard]] Tally tally_of(std::vector<double> values, bool is_independent, std::size_t most = 400);

/// An estimate as a function of the number of samples, with confidence intervals.
struct Running {
  std::vector<double> samples, value, low, high;
};
/// Returns the mean of the finite values with Student's confidence interval.
[[nodiscard]] Running running_mean(const std::vector<double>& values);
/// Returns the fraction of failures with the Clopper-Pearson interval. Per sample: `sure` is 1 for a failure; `possible` is 1 also for a
/// run without a result that may be one.
[[nodiscard]] Running running_share(const std::vector<char>& sure, const std::vector<char>& possible);

} // namespace steplap::study
