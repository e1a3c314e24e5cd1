// What all samplings of a probability share: how many samples they ask for at once, when they end, what they say then.
#pragma once

#include "tools/study/samplers.h"
#include "tools/study/weighted_mean.h"

namespace steplap::study {

/// A mean, or what is left of one, as a probability.
struct Share {
  double p = 0.0, deviation = std::numeric_limits<double>::infinity();
  Interval interval, test;
};
[[nodiscard]] Share share_of(const WeightedMean& mean, bool is_complement, const SamplingTarget& target);

class SamplingCourse {
public:
  SamplingCourse(LimitFunction& limit, const SamplingTarget& target);

  /// No sample is left, or the time is up.
  [[nodiscard]] bool is_over() { return is_late() || left() <= 0; }
  [[nodiscard]] bool is_late();
  [[nodiscard]] long used() const { return limit_.asked() - before_; }
  [[nodiscard]] long left() const { return target_.samples - used(); }
  /// Samples asked for at once: a number that hangs on the study alone.
  [[nodiscard]] std::size_t block() const { return block_; }

  /// Both bounds. The coefficient of variation is that of the less probable one of failing and holding: where nearly
  /// all samples fail, the probability that one holds is what is hard to know.
  void set(Estimate& e, const Share& safe, const Share& unsafe) const;
  /// Keeps the estimate as it grew. The coefficient of variation falls as the root of the number of samples.
  void note(Estimate& e);
  void say_why_it_ended(Estimate& e) const;
  /// How many values have to be drawn in all, judged by `drawn` of them with the coefficient of variation `cov`.
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
