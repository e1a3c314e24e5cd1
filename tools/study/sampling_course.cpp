#include "tools/study/sampling_course.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

Share share_of(const WeightedMean& mean, bool is_complement, const SamplingTarget& target) {
  Share share{std::min(1.0, mean.mean()), mean.deviation(), mean.interval(target.confidence), mean.interval(target.test_confidence)};
  if (!is_complement) return share;
  const auto rest = [](const Interval& i) { return Interval{1.0 - i.high, 1.0 - i.low}; };
  return {1.0 - share.p, share.deviation, rest(share.interval), rest(share.test)};
}

SamplingCourse::SamplingCourse(LimitFunction& limit, const SamplingTarget& target)
    : limit_(limit), target_(target), counts_bad_(limit.run().study().failed == "unsafe"),
      block_(static_cast<std::size_t>(std::clamp(target.samples / 50, 100L, 10000L))), before_(limit.asked()),
      begin_(limit.run().evaluator.seconds()) {}

bool SamplingCourse::is_late() {
  is_late_ = target_.seconds && limit_.run().evaluator.seconds() - begin_ > *target_.seconds;
  return is_late_;
}

void SamplingCourse::set(Estimate& e, const Share& safe, const Share& unsafe) const {
  e.safe = safe.p;
  e.unsafe = unsafe.p;
  e.safe_interval = safe.interval;
  e.unsafe_interval = unsafe.interval;
  e.safe_test = safe.test;
  e.unsafe_test = unsafe.test;
  const Share& asked = counts_bad_ ? unsafe : safe;
  const double rarer = std::min(asked.p, 1.0 - asked.p);
  e.cov = rarer > 0.0 ? asked.deviation / rarer : std::numeric_limits<double>::infinity();
  e.samples = used();
}

void SamplingCourse::note(Estimate& e) {
  limit_.run().evaluator.note(
      {e.method, limit_.subject(), "probability", e.unsafe, e.safe_interval.low, e.unsafe_interval.high, e.samples});
  const double wanted = static_cast<double>(e.samples) * std::pow(e.cov / target_.cov, 2), most = static_cast<double>(target_.samples);
  limit_.run().evaluator.expect(static_cast<long>(std::isfinite(wanted) ? std::min(wanted, most) : most) - e.samples, true);
}

void SamplingCourse::say_why_it_ended(Estimate& e) const {
  e.is_target_met = e.cov <= target_.cov;
  if (e.is_target_met) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s: coefficient of variation %.3g, %.3g was asked for", is_late_ ? "time was up" : "all samples used",
                e.cov, target_.cov);
  e.status = text;
}

long SamplingCourse::planned(long drawn, double cov) const {
  // The number is increased by 10 %, so that an underestimated scatter seldom requires another stage. It is at most eight times the present
  // number, because an early estimate of the scatter is poor.
  constexpr double k_margin = 1.1, k_most = 8.0;
  const double n = static_cast<double>(drawn), times = std::isfinite(cov) ? k_margin * std::pow(cov / target_.cov, 2) : k_most;
  return static_cast<long>(std::ceil(n * std::min(times, k_most)));
}

} // namespace steplap::study
