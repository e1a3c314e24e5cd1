// Statistics of samples for a page: distribution of values, and convergence of a mean.
//
// All samples are included, even if the page shows fewer. Bands and intervals have 95 % confidence and are given only for samples drawn
// independently.
#pragma once

#include "tools/study/law.h"

#include <vector>

namespace steplap::study {

/// Empirical distribution function at selected steps: fraction p of values up to x, with a confidence band.
struct Curve {
  std::vector<double> x, p, low, high;
};

/// Counts between edges (one more edge than counts), with confidence intervals of their fractions.
struct Histogram {
  std::vector<double> edges;
  std::vector<long> counts;
  std::vector<double> low, high;
};

/// Statistics of one column of samples.
struct Tally {
  long total = 0, missing = 0; ///< number of runs; of runs without a value
  long above = 0, below = 0;   ///< number of values +∞ and −∞
  double mean = 0.0;           ///< of the finite values
  Curve cumulative;            ///< for finite x; p includes infinite values
  Histogram histogram;         ///< of the finite values
};

/// Computes the statistics. The band is that of Dvoretzky, Kiefer and Wolfowitz with Massart's constant: it contains the whole distribution
/// function with 95 % confidence. Runs without a value (NaN) widen it on both sides. At most `most` steps are kept, evenly in p.
[[nodiscard]] Tally tally_of(std::vector<double> values, bool is_independent, std::size_t most = 400);

/// Estimate as a function of the number of samples.
struct Running {
  std::vector<double> samples, value, low, high;
};
/// Returns the mean of the finite values with Student's confidence interval.
[[nodiscard]] Running running_mean(const std::vector<double>& values);
/// Returns the fraction of failures with the Clopper-Pearson interval. `sure` is 1 for a failure; `possible` is 1 for a failure and for a
/// run that may be one.
[[nodiscard]] Running running_share(const std::vector<char>& sure, const std::vector<char>& possible);

} // namespace steplap::study
