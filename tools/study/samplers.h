// Estimates probabilities by sampling: Monte Carlo, importance sampling at design points, directional simulation, subset simulation and
// kriging.
// Each returns a confidence interval and a status.
#pragma once

#include "tools/study/design_points.h"
#include "tools/study/influence.h"

namespace steplap::study {

/// A probability. Runs without a result count as safe in `safe` and as failures in `unsafe`.
struct Estimate {
  std::string method;
  double safe = 0.0, unsafe = 0.0;
  Interval safe_interval, unsafe_interval;
  Interval safe_test, unsafe_test;                      ///< intervals of higher confidence, for comparison with other estimates
  double cov = std::numeric_limits<double>::infinity(); ///< coefficient of variation of the less probable outcome, failure or survival
  long samples = 0, bad = 0;
  std::string status;
  bool is_target_met = false;
  bool is_trusted = true;
  Influence influence;       ///< of the variables; only by methods whose samples have weights
  std::vector<Finding> more; ///< findings of this method alone

  /// Returns the interval for the study's treatment of failed runs. `failed` is "safe", "unsafe", or another word for bounds of both.
  [[nodiscard]] Interval interval(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_interval.low : safe_interval.low, failed == "safe" ? safe_interval.high : unsafe_interval.high};
  }
  [[nodiscard]] Interval test(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_test.low : safe_test.low, failed == "safe" ? safe_test.high : unsafe_test.high};
  }
};

/// End criteria of a sampling method.
struct SamplingTarget {
  double cov = 0.05;
  long samples = 100000;
  std::optional<double> seconds;
  double confidence = 0.95;
  double test_confidence = 0.99; ///< confidence of the intervals `safe_test` and `unsafe_test`
};

/// Crude Monte Carlo: the fraction of failing samples.
[[nodiscard]] Estimate monte_carlo(LimitFunction& limit, const SamplingTarget& target);
/// Samples around the design points; there must be at least one. Works in two stages: the first, whose samples are not counted, determines
/// the number of samples of the second. The estimate then does not influence when sampling ends, which would bias it.
///
/// A part of the samples is widely spread. If one of them fails far from all design points, a new search begins there, and sampling
/// restarts with the point found. If survival is less probable than failure around the design points, the probability of survival is
/// estimated and subtracted from one.
[[nodiscard]] Estimate importance_sampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target);
/// Samples along rays in random directions, at one random point in each stratum of the radius. Whether the point fails estimates the
/// stratum's contribution without bias, for any shape of the failure region. Works in two stages, like importance_sampling().
[[nodiscard]] Estimate directional(LimitFunction& limit, const SamplingTarget& target);
/// Uses nested levels, each a given fraction of the previous one, and repeats the whole `repetitions` times; the scatter gives the
/// interval. If values are equal, so that no further level exists, failures are counted directly.
[[nodiscard]] Estimate subset_simulation(LimitFunction& limit, const SamplingTarget& target);

/// Active learning: a surrogate by kriging says which samples of a Monte Carlo population fail, and asks for runs where it is in doubt. For
/// runs that are dear: at most 500 are made. Its interval contains the doubt and the scatter of the population.
[[nodiscard]] Estimate kriging(LimitFunction& limit, const SamplingTarget& target);

/// Adds the findings of an estimate to the answer.
void add_findings(const Estimate& estimate, const LimitFunction& limit, const std::string& failed, Answer& answer);

} // namespace steplap::study
