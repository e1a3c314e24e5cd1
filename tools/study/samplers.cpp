#include "tools/study/samplers.h"

#include <openturns/DistFunc.hxx>

#include <cmath>
#include <numbers>

namespace steplap::study {

namespace {

// Samples are asked for in blocks of a size that hangs on the study alone; estimates are looked at between them.
std::size_t block_of(const LimitFunction& limit, const SamplingTarget& target) {
  (void)limit;
  return static_cast<std::size_t>(std::clamp(target.samples / 50, 100L, 10000L));
}

class Clock {
public:
  Clock(LimitFunction& limit, const SamplingTarget& target)
      : limit_(limit), target_(target), begin_(limit.run().evaluator.seconds()) {}
  [[nodiscard]] bool is_over() const {
    return target_.seconds && limit_.run().evaluator.seconds() - begin_ > *target_.seconds;
  }

private:
  LimitFunction& limit_;
  const SamplingTarget& target_;
  double begin_;
};

void say_why_it_ended(Estimate& e, const SamplingTarget& target, bool is_late) {
  e.is_target_met = e.cov <= target.cov;
  if (e.is_target_met) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s: coefficient of variation %.3g, %.3g was asked for",
                is_late ? "time was up" : "all samples used", e.cov, target.cov);
  e.status = text;
}

// The coefficient of variation falls as the root of the number of samples.
void note_growth(LimitFunction& limit, const Estimate& e, const SamplingTarget& target) {
  Finding f{e.method, limit.subject(), "probability", e.unsafe, e.safe_interval.low, e.unsafe_interval.high, e.samples};
  limit.run().evaluator.note(f);
  const double wanted = static_cast<double>(e.samples) * std::pow(e.cov / target.cov, 2),
               most = static_cast<double>(target.samples);
  limit.run().evaluator.expect(static_cast<long>(std::isfinite(wanted) ? std::min(wanted, most) : most) - e.samples,
                               true);
}

// Sums of weights, and the interval of their mean.
struct WeightSum {
  double sum = 0.0, squares = 0.0, largest = 0.0;
  long count = 0, hits = 0;
  void add(double w) {
    ++count;
    if (w <= 0.0) return;
    ++hits;
    sum += w;
    squares += w * w;
    largest = std::max(largest, w);
  }
  [[nodiscard]] double mean() const { return count ? sum / static_cast<double>(count) : 0.0; }
  [[nodiscard]] double cov() const {
    if (hits < 2) return std::numeric_limits<double>::infinity();
    const double n = static_cast<double>(count), m = mean();
    return std::sqrt(std::max(0.0, squares / n - m * m) / (n - 1.0)) / m;
  }
  [[nodiscard]] Interval interval(double confidence) const {
    if (hits < 2) return {0.0, 1.0};
    const double half = student_quantile(static_cast<double>(hits - 1), 0.5 * (1.0 + confidence)) * cov() * mean();
    return {std::max(0.0, mean() - half), std::min(1.0, mean() + half)};
  }
};

} // namespace

SamplingTarget target_of(const ReliabilitySettings& s) { return {s.cov, s.samples, s.seconds, s.confidence}; }

Estimate monte_carlo(LimitFunction& limit, const SamplingTarget& target) {
  const std::size_t n = limit.dimension(), block = block_of(limit, target);
  const CounterRandom random(static_cast<std::uint64_t>(limit.run().study().seed), 1);
  const Clock clock(limit, target);
  Estimate e;
  e.method = "monte_carlo";
  double failures = 0.0, bad = 0.0;
  bool is_late = false;
  std::vector<double> points;
  while (e.samples < target.samples && !(e.cov <= target.cov) && !(is_late = clock.is_over())) {
    const std::size_t count = std::min(block, static_cast<std::size_t>(target.samples - e.samples));
    points.clear();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t d = 0; d < n; ++d)
        points.push_back(random.normal(static_cast<std::uint64_t>(e.samples) + i, static_cast<std::uint32_t>(d)));
    for (const LimitValue& value : limit.at(points)) {
      bad += value.is_bad;
      failures += !value.is_bad && value.g < 0.0;
    }
    e.samples += static_cast<long>(count);
    const double total = static_cast<double>(e.samples);
    e.safe = failures / total;
    e.unsafe = (failures + bad) / total;
    e.safe_interval = proportion_interval(failures, total, target.confidence);
    e.unsafe_interval = proportion_interval(failures + bad, total, target.confidence);
    // Of the failures proper: runs without a result are no information about the probability.
    if (failures > 0.0) e.cov = std::sqrt((1.0 - e.safe) / failures);
    e.bad = static_cast<long>(bad);
    note_growth(limit, e, target);
  }
  say_why_it_ended(e, target, is_late);
  if (failures == 0.0) e.status = "no failure among " + std::to_string(e.samples) + " samples: only a bound is known";
  return e;
}

namespace {

// Where importance sampling draws: normal around each design point, and a wide one around the origin.
class Proposal {
public:
  Proposal(const std::vector<DesignPoint>& points, std::size_t dimension) : dimension_(dimension) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const DesignPoint& p : points) nearest = std::min(nearest, std::abs(p.beta));
    constexpr double k_too_far = 3.0; // what lies so much further matters little
    for (const DesignPoint& p : points)
      if (std::abs(p.beta) < nearest + k_too_far) centres_.push_back(p.u);
    wide_ = std::max(1.0, 1.2 * nearest / std::sqrt(static_cast<double>(dimension)));
  }

  void draw(const CounterRandom& random, std::uint64_t sample, std::vector<double>& points) const {
    const double share = random.uniform(sample, 0);
    const bool is_wide = share < k_wide;
    const std::size_t k =
        is_wide ? 0
                : std::min(centres_.size() - 1, static_cast<std::size_t>((share - k_wide) / (1.0 - k_wide) *
                                                                         static_cast<double>(centres_.size())));
    for (std::size_t d = 0; d < dimension_; ++d) {
      const double z = random.normal(sample, static_cast<std::uint32_t>(d + 2));
      points.push_back(is_wide ? wide_ * z : centres_[k][d] + z);
    }
  }

  /// Nearly nothing is drawn there but by the wide part: a failure there tells of a design point that is not known.
  [[nodiscard]] bool is_stray(const double* u) const { return wide_part(u) * weight(u) > 0.9; }

  /// Density of the standard normal over that of the proposal.
  [[nodiscard]] double weight(const double* u) const {
    double sum = wide_part(u);
    for (const auto& c : centres_) {
      double product = 0.0, own = 0.0;
      for (std::size_t d = 0; d < dimension_; ++d) product += u[d] * c[d], own += c[d] * c[d];
      sum += (1.0 - k_wide) / static_cast<double>(centres_.size()) * std::exp(product - 0.5 * own);
    }
    return 1.0 / sum;
  }

private:
  // Densities over that of the standard normal.
  [[nodiscard]] double wide_part(const double* u) const {
    const double distance = length_of(u, dimension_);
    return k_wide * std::pow(wide_, -static_cast<double>(dimension_)) *
           std::exp(0.5 * distance * distance * (1.0 - 1.0 / (wide_ * wide_)));
  }

  static constexpr double k_wide = 0.2;
  std::size_t dimension_;
  std::vector<std::vector<double>> centres_;
  double wide_ = 1.0;
};

} // namespace

Estimate importance_sampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target) {
  const std::size_t n = limit.dimension(), block = std::min<std::size_t>(block_of(limit, target), 1000);
  const CounterRandom random(static_cast<std::uint64_t>(limit.run().study().seed), 4);
  Proposal proposal(design.points, n);
  const Clock clock(limit, target);
  Estimate e;
  e.method = "importance_sampling";
  WeightSum safe, unsafe;
  bool is_late = false;
  int searches = 0;
  constexpr int k_most_searches = 12;
  std::vector<double> points, stray;
  double nearest_stray = std::numeric_limits<double>::infinity();
  constexpr long k_fewest = 500; // before that an estimate of the scatter says little
  while (e.samples < target.samples && !(safe.count >= k_fewest && e.cov <= target.cov) &&
         !(is_late = clock.is_over())) {
    const std::size_t count = std::min(block, static_cast<std::size_t>(target.samples - e.samples));
    points.clear();
    for (std::size_t i = 0; i < count; ++i) proposal.draw(random, static_cast<std::uint64_t>(e.samples) + i, points);
    const std::vector<LimitValue>& values = limit.at(points);
    for (std::size_t i = 0; i < count; ++i) {
      const bool fails = !values[i].is_bad && values[i].g < 0.0;
      const double w = fails || values[i].is_bad ? proposal.weight(&points[i * n]) : 0.0;
      safe.add(fails ? w : 0.0);
      unsafe.add(w);
      e.bad += values[i].is_bad;
      const double distance = fails ? length_of(&points[i * n], n) : nearest_stray;
      if (distance >= nearest_stray || !proposal.is_stray(&points[i * n])) continue;
      nearest_stray = distance;
      stray.assign(&points[i * n], &points[i * n] + n);
    }
    e.samples += static_cast<long>(count);
    if (!stray.empty() && searches < k_most_searches) {
      ++searches;
      const bool is_new = search_again(limit, stray, design);
      stray.clear();
      if (is_new) { // begun anew: what was drawn until now does not tell how it was chosen
        proposal = Proposal(design.points, n);
        safe = unsafe = {};
        nearest_stray = e.cov = std::numeric_limits<double>::infinity();
        e.bad = 0;
        continue;
      }
    }
    e.safe = safe.mean();
    e.unsafe = unsafe.mean();
    e.safe_interval = safe.interval(target.confidence);
    e.unsafe_interval = unsafe.interval(target.confidence);
    e.cov = safe.cov();
    note_growth(limit, e, target);
  }
  say_why_it_ended(e, target, is_late);
  constexpr double k_uneven = 0.1;
  if (safe.hits == 0) {
    e.status = "no failure was met around the design points";
    e.is_trusted = false;
  } else if (safe.largest > k_uneven * safe.sum) {
    e.status += std::string(e.status.empty() ? "" : "; ") +
                "one sample carries more than a tenth of the estimate: its interval is not to be relied on";
    e.is_trusted = false;
  }
  return e;
}

namespace {

// Beyond the radius what is left is below 1e-16 of the probability space, or so.
double reach_of(std::size_t n) {
  return std::sqrt(OT::DistFunc::qGamma(0.5 * static_cast<double>(n), 1e-16, true) * 2.0);
}
// Probability of being further out than r in n dimensions.
double beyond(std::size_t n, double r) { return OT::DistFunc::pGamma(0.5 * static_cast<double>(n), 0.5 * r * r, true); }

struct Bracket {
  std::size_t ray;
  double low, high, g_low, g_high;
  int stuck = 0; ///< rounds in which the same end stood still
};

// Crossings of g along rays from the origin, all rays at a time: a look at even distances, then Illinois' rule. Where a
// run has no result it counts as safe, or as a failure; what is closed in beside it is where there are results again.
class Rays {
public:
  Rays(LimitFunction& limit, std::vector<double> directions)
      : limit_(limit), directions_(std::move(directions)), n_(limit.dimension()), count_(directions_.size() / n_) {
    std::vector<double> points;
    for (std::size_t i = 0; i < count_; ++i)
      for (int k = 1; k <= k_looks; ++k) add(points, i, reach_of(n_) * k / k_looks);
    looks_ = limit_.at(points);
  }

  /// Rays on which a run had no result.
  [[nodiscard]] std::vector<char> bad() const {
    std::vector<char> is_bad(count_, 0);
    for (std::size_t k = 0; k < looks_.size(); ++k)
      if (looks_[k].is_bad) is_bad[k / k_looks] = 1;
    return is_bad;
  }

  /// Probability of failure on each ray, given its direction, from `origin` on.
  std::vector<double> probabilities(double origin, bool is_bad_unsafe) {
    const double reach = reach_of(n_);
    std::vector<Bracket> open;
    for (std::size_t i = 0; i < count_; ++i) {
      double before = origin;
      for (int k = 1; k <= k_looks; ++k) {
        const double here = value_of(looks_[i * k_looks + static_cast<std::size_t>(k - 1)], is_bad_unsafe);
        if ((here < 0.0) != (before < 0.0))
          open.push_back({i, reach * (k - 1) / k_looks, reach * k / k_looks, before, here});
        before = here;
      }
    }
    close(open, is_bad_unsafe);
    std::vector<double> probability(count_, origin < 0.0 ? 1.0 : 0.0);
    for (const Bracket& b : open) { // ascending on each ray: in and out of failure
      const double tail = beyond(n_, 0.5 * (b.low + b.high));
      probability[b.ray] += b.g_high < 0.0 ? tail : -tail;
    }
    return probability;
  }

private:
  static constexpr int k_looks = 16;
  static constexpr double k_close = 1e-6;
  static constexpr double k_hole = std::numeric_limits<double>::infinity();

  static double value_of(const LimitValue& value, bool is_bad_unsafe) {
    return !value.is_bad ? value.g : is_bad_unsafe ? -k_hole : k_hole;
  }

  void add(std::vector<double>& points, std::size_t ray, double r) const {
    for (std::size_t d = 0; d < n_; ++d) points.push_back(r * directions_[ray * n_ + d]);
  }

  void close(std::vector<Bracket>& brackets, bool is_bad_unsafe) {
    for (int round = 0; round < 60; ++round) {
      std::vector<double> points, at;
      std::vector<std::size_t> which;
      for (std::size_t k = 0; k < brackets.size(); ++k) {
        const Bracket& b = brackets[k];
        if (b.high - b.low < k_close) continue;
        double r = b.high - b.g_high * (b.high - b.low) / (b.g_high - b.g_low); // not a number beside a hole
        if (!(r > b.low && r < b.high) || round % 4 == 3) r = 0.5 * (b.low + b.high);
        which.push_back(k);
        at.push_back(r);
        add(points, b.ray, r);
      }
      if (which.empty()) return;
      const std::vector<LimitValue>& values = limit_.at(points);
      for (std::size_t i = 0; i < which.size(); ++i) {
        Bracket& b = brackets[which[i]];
        const double g = value_of(values[i], is_bad_unsafe);
        if ((g < 0.0) == (b.g_low < 0.0)) {
          b.low = at[i], b.g_low = g;
          b.stuck = b.stuck > 0 ? b.stuck + 1 : 1;
          if (b.stuck > 1) b.g_high *= 0.5;
        } else {
          b.high = at[i], b.g_high = g;
          b.stuck = b.stuck < 0 ? b.stuck - 1 : -1;
          if (b.stuck < -1) b.g_low *= 0.5;
        }
      }
    }
  }

  LimitFunction& limit_;
  std::vector<double> directions_;
  std::size_t n_, count_;
  std::vector<LimitValue> looks_;
};

} // namespace

Estimate directional(LimitFunction& limit, const SamplingTarget& target) {
  const std::size_t n = limit.dimension();
  constexpr std::size_t k_rays = 32; // at a time
  constexpr long k_fewest = 64;
  const CounterRandom random(static_cast<std::uint64_t>(limit.run().study().seed), 5);
  const Clock clock(limit, target);
  const long before = limit.asked();
  Estimate e;
  e.method = "directional";
  const LimitValue origin = limit.at_point(std::vector<double>(n, 0.0));
  if (origin.is_bad) {
    e.status = "the run at the origin has no result: there is nowhere to look from";
    e.is_trusted = false;
    e.safe_interval = e.unsafe_interval = {0.0, 1.0};
    return e;
  }
  WeightSum safe, unsafe;
  bool is_late = false;
  std::uint64_t ray = 0;
  while (limit.asked() - before < target.samples && !(safe.count >= k_fewest && e.cov <= target.cov) &&
         !(is_late = clock.is_over())) {
    std::vector<double> directions(k_rays * n);
    for (std::size_t i = 0; i < k_rays; ++i, ++ray) {
      for (std::size_t d = 0; d < n; ++d) directions[i * n + d] = random.normal(ray, static_cast<std::uint32_t>(d));
      const double length = length_of(&directions[i * n], n);
      for (std::size_t d = 0; d < n; ++d) directions[i * n + d] /= length;
    }
    Rays rays(limit, directions);
    const std::vector<char> is_bad = rays.bad();
    const auto holes = std::count(is_bad.begin(), is_bad.end(), 1);
    const std::vector<double> least = rays.probabilities(origin.g, false);
    const std::vector<double> most = holes > 0 ? rays.probabilities(origin.g, true) : least;
    for (std::size_t i = 0; i < k_rays; ++i) {
      safe.add(least[i]);
      unsafe.add(most[i]);
    }
    e.bad += holes;
    e.samples = limit.asked() - before;
    e.safe = safe.mean();
    e.unsafe = unsafe.mean();
    e.safe_interval = safe.interval(target.confidence);
    e.unsafe_interval = unsafe.interval(target.confidence);
    e.cov = safe.cov();
    note_growth(limit, e, target);
  }
  say_why_it_ended(e, target, is_late);
  if (safe.hits == 0) e.status = "no ray met failure";
  constexpr double k_uneven = 0.2;
  if (safe.hits && safe.largest > k_uneven * safe.sum) {
    e.status += std::string(e.status.empty() ? "" : "; ") +
                "one ray carries more than a fifth of the estimate: its interval is not to be relied on";
    e.is_trusted = false;
  }
  return e;
}

void add_findings(const Estimate& e, const LimitFunction& limit, const std::string& failed, Answer& answer) {
  const bool is_both = e.bad > 0 && failed == "bounds";
  const auto add = [&](const char* quantity, double p, const Interval& interval) {
    answer.findings.push_back(
        {e.method, limit.subject(), quantity, p, interval.low, interval.high, e.samples, e.status});
    const auto beta = [](double q) { return q > 0.0 && q < 1.0 ? -normal_quantile(q) : std::nan(""); };
    answer.findings.push_back(
        {e.method, limit.subject(), "beta", beta(p), beta(interval.high), beta(interval.low), e.samples, e.status});
  };
  if (!is_both)
    add("probability", failed == "unsafe" ? e.unsafe : e.safe,
        failed == "unsafe" ? e.unsafe_interval : e.safe_interval);
  if (is_both) add("probability, runs without result as safe", e.safe, e.safe_interval);
  if (is_both) add("probability, runs without result as unsafe", e.unsafe, e.unsafe_interval);
  if (!e.is_trusted) answer.degrade(Standing::not_trusted);
  else if (!e.is_target_met) answer.degrade(Standing::not_met);
}

} // namespace steplap::study
