// Estimates probabilities by sampling: Monte Carlo, importance sampling at design points, subset simulation and kriging. Each returns a
// confidence interval and a status.
#pragma once

#include "tools/study/design_points.h"
#include "tools/study/influence.h"

namespace steplap::study {

/// Estimate of a probability. `safe` counts runs without a result as survivals, `unsafe` as failures.
struct Estimate {
  std::string method;
  double safe = 0.0, unsafe = 0.0;
  Interval safe_interval, unsafe_interval;
  Interval safe_test, unsafe_test; ///< intervals with a higher confidence, for comparisons with other estimates
  /// coefficient of variation of the probability of failure, or of survival if that is smaller
  double cov = std::numeric_limits<double>::infinity();
  long samples = 0, bad = 0;
  std::string status;
  bool is_target_met = false;
  bool is_trusted = true;
  bool is_covered = true;    ///< false if samples and searches do not show that all regions of failure were met
  Influence influence;       ///< of the variables; only by methods whose samples have weights
  std::vector<Finding> more; ///< findings of this method alone

  /// Returns the interval according to the setting `failed`: "safe" or "unsafe" select that treatment of runs without a result; another
  /// word gives the interval that contains both.
  [[nodiscard]] Interval interval(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_interval.low : safe_interval.low, failed == "safe" ? safe_interval.high : unsafe_interval.high};
  }
  [[nodiscard]] Interval test(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_test.low : safe_test.low, failed == "safe" ? safe_test.high : unsafe_test.high};
  }
};

/// Conditions that end the sampling.
struct SamplingTarget {
  double cov = 0.05;
  long samples = 100000;
  std::optional<double> seconds;
  double confidence = 0.95;
  double test_confidence = 0.99; ///< confidence of the intervals `safe_test` and `unsafe_test`
};

/// Crude Monte Carlo: the fraction of failing samples.
[[nodiscard]] Estimate monte_carlo(LimitFunction& limit, const SamplingTarget& target);
/// Importance sampling around the design points, of which there must be at least one. A first stage determines the number of samples of the
/// second and is then discarded; otherwise the estimate would influence the end of sampling and be biased.
///
/// The sampling density has a wide component. If one of its samples fails far from all design points, a new search starts there, and
/// sampling restarts with the point found. If it meets few failures, searches go on from places away from all design points. If survival is
/// less probable than failure around the design points, the probability of survival is estimated instead.
[[nodiscard]] Estimate importance_sampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target);
/// Subset simulation: nested levels, each with a given fraction of the previous one's probability. Repeats the whole simulation
/// `repetitions` times; their scatter gives the interval. Failures are counted directly if equal values prevent a further level.
[[nodiscard]] Estimate subset_simulation(LimitFunction& limit, const SamplingTarget& target);

/// Active learning: a surrogate by kriging says which samples of a Monte Carlo population fail, and asks for runs where it is in doubt. For
/// runs that are dear: at most 500 are made. Its interval contains the doubt and the scatter of the population.
[[nodiscard]] Estimate kriging(LimitFunction& limit, const SamplingTarget& target);

/// Adds the findings of an estimate to the answer.
void add_findings(const Estimate& estimate, const LimitFunction& limit, const std::string& failed, Answer& answer);

} // namespace steplap::study
