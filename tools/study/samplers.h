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
  double cov = std::numeric_limits<double>::infinity(); ///< of the larger
  long samples = 0, bad = 0;
  std::string status;
  bool is_target_met = false;
  bool is_trusted = true;

  /// Both, as far as the study counts them.
  [[nodiscard]] Interval interval(const std::string& failed) const {
    return {failed == "unsafe" ? unsafe_interval.low : safe_interval.low,
            failed == "safe" ? safe_interval.high : unsafe_interval.high};
  }
};

struct SamplingTarget {
  double cov = 0.05;
  long samples = 100000;
  std::optional<double> seconds;
  double confidence = 0.95;
};
[[nodiscard]] SamplingTarget target_of(const ReliabilitySettings& settings);

[[nodiscard]] Estimate monte_carlo(LimitFunction& limit, const SamplingTarget& target);
/// Around the design points, of which there is at least one. A share of the samples is spread widely: where one of them
/// fails far from all design points a search begins there, and sampling begins anew around what it finds as well.
[[nodiscard]] Estimate importance_sampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target);
[[nodiscard]] Estimate directional(LimitFunction& limit, const SamplingTarget& target);
[[nodiscard]] Estimate subset_simulation(LimitFunction& limit, const SamplingTarget& target);

/// The findings that an estimate makes.
void add_findings(const Estimate& estimate, const LimitFunction& limit, const std::string& failed, Answer& answer);

} // namespace steplap::study
