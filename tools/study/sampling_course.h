// Common parts of all sampling methods: batch size, end criteria and status.
#pragma once

#include "tools/study/samplers.h"
#include "tools/study/weighted_mean.h"

namespace steplap::study {

/// An estimated probability with its interval.
struct Share {
  double p = 0.0, deviation = std::numeric_limits<double>::infinity();
  Interval interval, test;
};
/// Converts a mean to a probability; `is_complement`: the mean is the probability of survival.
[[nodiscard]] Share share_of(const WeightedMean& mean, bool is_complement, const SamplingTarget& target);

/// Progress of one sampling method.
class SamplingCourse {
public:
  SamplingCourse(LimitFunction& limit, const SamplingTarget& target);

  /// Returns true if runs without a result count as failures.
  [[nodiscard]] bool counts_bad() const { return counts_bad_; }
  /// Returns true if the limit on samples or on time is reached.
  [[nodiscard]] bool is_over() { return is_late() || left() <= 0; }
  [[nodiscard]] bool is_late();
  /// Returns the number of samples used so far.
  [[nodiscard]] long used() const { return limit_.asked() - before_; }
  [[nodiscard]] long left() const { return target_.samples - used(); }
  /// Returns the number of samples per batch. It depends on the study only.
  [[nodiscard]] std::size_t block() const { return block_; }

  /// Sets both bounds of `e` and their coefficient of variation, which refers to failure or survival, whichever is less probable,
  /// and counts runs without a result as the study asks.
  void set(Estimate& e, const Share& safe, const Share& unsafe) const;
  /// Stores an intermediate estimate. The samples still needed are predicted from cov ∝ 1/√n.
  void note(Estimate& e);
  void say_why_it_ended(Estimate& e) const;
  /// Returns the total number of values required, given the coefficient of variation `cov` of `drawn` values.
  [[nodiscard]] long planned(long drawn, double cov) const;

private:
  LimitFunction& limit_;
  const SamplingTarget& target_;
  bool counts_bad_; ///< runs without a result count as failures
  std::size_t block_;
  long before_;
  double begin_;
  bool is_late_ = false;
};

} // namespace steplap::study
