#include "tools/study/samplers.h"

#include "tools/study/sampling_course.h"

#include <cmath>

namespace steplap::study {

namespace {

// Returns the fraction of failures with its standard deviation and confidence intervals (Clopper and Pearson).
Share counted(double failures, double samples, const SamplingTarget& target) {
  const double p = failures / samples;
  return {p, std::sqrt(p * (1.0 - p) / samples), proportion_interval(failures, samples, target.confidence),
          proportion_interval(failures, samples, target.test_confidence)};
}

} // namespace

Estimate monte_carlo(LimitFunction& limit, const SamplingTarget& target) {
  const std::size_t n = limit.dimension();
  const CounterRandom random(static_cast<std::uint64_t>(limit.run().study().seed), 1);
  SamplingCourse course(limit, target);
  Estimate e;
  e.method = "monte_carlo";
  e.influence = Influence(limit.run().law);
  double failures = 0.0, bad = 0.0, total = 0.0;
  std::vector<double> points;
  while (!(e.cov <= target.cov) && !course.is_over()) {
    const std::size_t count = std::min(course.block(), static_cast<std::size_t>(course.left()));
    points.clear();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t d = 0; d < n; ++d)
        points.push_back(random.normal(static_cast<std::uint64_t>(total) + i, static_cast<std::uint32_t>(d)));
    const std::vector<LimitValue>& values = limit.at(points);
    for (std::size_t i = 0; i < count; ++i) {
      bad += values[i].is_bad;
      failures += !values[i].is_bad && values[i].g < 0.0;
      e.influence.add(&points[i * n], 1.0, values[i]);
    }
    total += static_cast<double>(count);
    course.set(e, counted(failures, total, target), counted(failures + bad, total, target));
    e.bad = static_cast<long>(bad);
    course.note(e);
  }
  course.say_why_it_ended(e);
  const std::string all = std::to_string(e.samples) + " samples: only a bound is known";
  if (failures + (course.counts_bad() ? bad : 0.0) == 0.0) e.status = "no failure among " + all;
  if (failures + bad == total && (bad == 0.0 || course.counts_bad())) e.status = "only failures among " + all;
  return e;
}

void add_findings(const Estimate& e, const LimitFunction& limit, const std::string& failed, Answer& answer) {
  const bool is_both = e.bad > 0 && failed == "bounds";
  const auto add = [&](const char* quantity, double p, const Interval& interval) {
    answer.findings.push_back({e.method, limit.subject(), quantity, p, interval.low, interval.high, e.samples, e.status});
    const auto beta = [](double q) { return q > 0.0 && q < 1.0 ? -normal_quantile(q) : std::nan(""); };
    answer.findings.push_back({e.method, limit.subject(), "beta", beta(p), beta(interval.high), beta(interval.low), e.samples, e.status});
  };
  if (!is_both) add("probability", failed == "unsafe" ? e.unsafe : e.safe, failed == "unsafe" ? e.unsafe_interval : e.safe_interval);
  if (is_both) add("probability, runs without result as safe", e.safe, e.safe_interval);
  if (is_both) add("probability, runs without result as unsafe", e.unsafe, e.unsafe_interval);
  for (Finding f : e.more) {
    f.samples = e.samples;
    answer.findings.push_back(std::move(f));
  }
  if (!e.is_trusted) answer.degrade(Standing::not_trusted);
  else if (!e.is_target_met) answer.degrade(Standing::not_met);
}

} // namespace steplap::study
