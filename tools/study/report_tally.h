// What a page draws of many samples: how values are distributed, and how a mean settled as samples came in.
//
// All samples count, however many a page then shows. Bands and intervals are of 95 %; they are given only of samples
// that were drawn independently of each other.
#pragma once

#include "tools/study/law.h"

#include <vector>

namespace steplap::study {

/// The empirical distribution at some of its steps: share p of values up to x, within a band.
struct Curve {
  std::vector<double> x, p, low, high;
};

/// Counts between edges, of which there is one more; the intervals of their shares.
struct Histogram {
  std::vector<double> edges;
  std::vector<long> counts;
  std::vector<double> low, high;
};

struct Tally {
  long total = 0, missing = 0; ///< runs; those without a value
  long above = 0, below = 0;   ///< at plus, at minus infinity
  double mean = 0.0;           ///< of finite values
  Curve cumulative;            ///< of finite values; p counts the infinite ones, too
  Histogram histogram;         ///< of finite values
};

/// The band is Dvoretzky, Kiefer and Wolfowitz's with Massart's constant: the whole distribution lies within it at 95
/// %. Runs without a value could be anywhere: they widen it on both sides. Not-a-number: no value. At most `most` steps
/// are kept, evenly in p.
[[nodiscard]] Tally tally_of(std::vector<double> values, bool is_independent, std::size_t most = 400);

/// An estimate after so many samples.
struct Running {
  std::vector<double> samples, value, low, high;
};
/// Mean of the finite values, with Student's interval.
[[nodiscard]] Running running_mean(const std::vector<double>& values);
/// Share of failures with Clopper and Pearson's interval; `sure` holds 1 for a failure, `possible` also for a run that
/// may count as one.
[[nodiscard]] Running running_share(const std::vector<char>& sure, const std::vector<char>& possible);

} // namespace steplap::study
