// Common parts of all sampling methods: batch size, end criteria and status.
#pragma once

#include "tools/study/samplers.h"
#include "tools/study/weighted_mean.h"

namespace steplap::study {

/// An estimated mean, or its complement to one, as a probability.
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

  /// Returns true if no sample is left or the time is over.
  [[nodiscard]] bool is_over() { return is_late() || left() <= 0; }
  [[nodiscard]] bool is_late();
  /// Returns the number of samples used so far.
  [[nodiscard]] long used() const { return limit_.asked() - before_; }
  [[nodiscard]] long left() const { return target_.samples - used(); }
  /// Returns the number of samples per batch. It depends on the study only.
  [[nodiscard]] std::size_t block() const { return block_; }

  /// Sets both bounds. The coefficient of variation refers to the less probable outcome: if nearly all samples fail, the probability of
  /// survival is the uncertain one.
  void set(Estimate& e, const Share& safe, const Share& unsafe) const;
  /// Stores the intermediate estimate. The coefficient of variation is assumed to decrease with the square root of the number of samples.
  void note(Estimate& e);
  void say_why_it_ended(Estimate& e) const;
  /// Returns the total number of values required, given the coefficient of variation `cov` of `drawn` values.
  [[nodiscard]] long planned(long drawn, double cov) const;

private:
  LimitFunction& limit_;
  const SamplingTarget& target_;
  std::size_t block_;
  long before_;
  double begin_;
  bool is_late_ = false;
};

} // namespace steplap::study
