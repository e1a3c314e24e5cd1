// Probabilities by sampling: crude Monte Carlo, importance sampling at design points, directional simulation and subset
// simulation. Each gives an interval and says what is to be known about it.
#pragma once

#include "tools/study/design_points.h"

namespace steplap::study {

/// A probability with what runs without a result make of it: they count as safe for `safe`, as failures for `unsafe`.
struct Estimate {
  std::string method;
  double safe = 0.0, unsafe = 0.0;
  Interval safe_interval, unsafe_interval;
  Interval safe_test, unsafe_test;                      ///< wider ones, for comparing it with others
  double cov = std::numeric_limits<double>::infinity(); ///< of the less probable one of failing and holding
  long samples = 0, bad = 0;
  std::string status;
  bool is_target_met = false;
  bool is_trusted = true;

  /// Both, as far as the study counts them.
  [[nodiscard]] Interval interval(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_interval.low : safe_interval.low, failed == "safe" ? safe_interval.high : unsafe_interval.high};
  }
  [[nodiscard]] Interval test(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_test.low : safe_test.low, failed == "safe" ? safe_test.high : unsafe_test.high};
  }
};

struct SamplingTarget {
  double cov = 0.05;
  long samples = 100000;
  std::optional<double> seconds;
  double confidence = 0.95;
  double test_confidence = 0.99; ///< of the intervals that estimates are compared by
};

[[nodiscard]] Estimate monte_carlo(LimitFunction& limit, const SamplingTarget& target);
/// Around the design points, of which there is at least one. In two stages: the first, whose samples are not counted,
/// tells how many the second has to take, so that the estimate does not decide when it is looked at.
///
/// A share of the samples is spread widely: where one of them fails far from all design points a search begins there,
/// and sampling begins anew around what it finds as well. Where more holds than fails around the design points the
/// probability of holding is what is found, and the estimate is what is left of one.
[[nodiscard]] Estimate importance_sampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target);
/// Along rays in random directions, one look at a random place in each of their strata: whether it fails is the
/// estimate of the stratum, which is right in the mean whatever the shape of the failures. Also in two stages.
[[nodiscard]] Estimate directional(LimitFunction& limit, const SamplingTarget& target);
/// By levels, each a share of the one before, `repetitions` times over: their scatter makes the interval. Where values
/// tie, so that no level lies between, what fails is counted.
[[nodiscard]] Estimate subset_simulation(LimitFunction& limit, const SamplingTarget& target);

/// The findings that an estimate makes.
void add_findings(const Estimate& estimate, const LimitFunction& limit, const std::string& failed, Answer& answer);

} // namespace steplap::study
