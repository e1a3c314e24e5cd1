// Subset simulation (Au and Beck, 2001), repeated independently; the scatter of the repetitions gives the interval.
//
// A level is the set of samples strictly below a threshold. Its probability is the fraction of samples in it: a tenth, or as close to a
// tenth as equal values permit. Samples within a level are drawn by Markov chains that start at samples found in it. The proposal of a
// chain is c u + s z with c² + s² = 1 and z standard normal, accepted if it is in the level (Papaioannou, Betz, Zwirglmaier and Straub,
// 2015). This preserves the normal distribution.
//
// If most samples have the same value, for example of a limit state with only two values, no further level exists. Failures are then
// counted directly.
#include "tools/study/reliability.h"
#include "tools/study/sampling_course.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

constexpr double k_share = 0.1;   // probability of a level relative to the previous one
constexpr double k_least = 1e-30; // smallest probability that can be reached

struct Repetition {
  double probability = 0.0, cov = 0.0;
  long failures = 0, samples = 0; ///< counts of the first level if it is the only one; otherwise 0
  bool is_counted = false;        ///< true if failures were counted in the first level, because no further level existed
  std::string problem;
};

// Threshold of the next level, and number of samples below it.
struct Threshold {
  double g = 0.0;
  std::size_t below = 0;
};

// Returns the threshold for the values g. Returns nothing if equal values prevent a level between the samples and failure.
std::optional<Threshold> next_threshold(std::vector<double> g) {
  constexpr std::size_t k_fewest = 10; // smallest number of chains; results of fewer depend too much on their starting points
  std::sort(g.begin(), g.end());
  const std::size_t n = g.size(), wanted = std::max(static_cast<std::size_t>(k_share * static_cast<double>(n)), k_fewest);
  const auto at = g.begin() + static_cast<long>(wanted);
  const auto first = std::lower_bound(g.begin(), g.end(), *at), past = std::upper_bound(g.begin(), g.end(), *at);
  const auto below = static_cast<std::size_t>(first - g.begin()), up_to = static_cast<std::size_t>(past - g.begin());
  if (2 * below >= wanted) return Threshold{*at, below};
  if (past != g.end() && 2 * up_to <= n) return Threshold{*past, up_to}; // the level includes the samples equal to the threshold
  const auto failing = static_cast<std::size_t>(std::lower_bound(g.begin(), g.end(), 0.0) - g.begin());
  if (below > failing && below >= k_fewest) return Threshold{*at, below};
  return {};
}

class Chains {
public:
  Chains(LimitFunction& limit, bool is_bad_unsafe, long k)
      : limit_(limit), is_bad_unsafe_(is_bad_unsafe), n_(limit.dimension()),
        size_(static_cast<std::size_t>(limit.settings().subset_samples)),
        random_(static_cast<std::uint64_t>(limit.run().study().seed), k_stream + static_cast<std::uint32_t>(k)) {}

  Repetition run() {
    draw_first();
    double probability = 1.0, square = 0.0;
    for (int level = 0;; ++level) {
      const double failures = static_cast<double>(std::count_if(g_.begin(), g_.end(), [](double g) { return g < 0.0; })),
                   share = failures / static_cast<double>(size_);
      std::optional<Threshold> next;
      if (share < k_share) next = next_threshold(g_);
      if (!next) {
        if (failures == 0.0) return failed("no failure was met: its levels came no nearer");
        const bool is_counted = share < k_share;
        if (level == 0)
          return {share, std::sqrt((1.0 - share) / failures), static_cast<long>(failures), static_cast<long>(size_), is_counted, ""};
        if (is_counted && failures < 10.0) return failed("most samples have one value, and too few of them fail to be counted");
        return {probability * share, std::sqrt(square + variation(0.0, share)), 0, 0, false, ""};
      }
      if (probability < k_least) return failed("its levels did not arrive at failure");
      const double part = static_cast<double>(next->below) / static_cast<double>(size_);
      square += variation(next->g, part);
      probability *= part;
      go_on(*next);
    }
  }

private:
  static constexpr std::uint32_t k_stream = 1000; // first stream number; each repetition uses its own stream, shared by both bounds
  static Repetition failed(const char* problem) { return {0.0, 0.0, 0, 0, false, problem}; }

  // Returns the limit function at the points. Runs without a result get the smallest or largest value, depending on the bound.
  std::vector<double> values_at(const std::vector<double>& points) {
    constexpr double k_extreme = 1e300;
    std::vector<double> g;
    for (const LimitValue& value : limit_.at(points)) g.push_back(value.is_bad ? (is_bad_unsafe_ ? -k_extreme : k_extreme) : value.g);
    return g;
  }

  double draw(std::size_t d) { return random_.normal(next_, static_cast<std::uint32_t>(d)); }

  void draw_first() {
    for (std::size_t i = 0; i < size_; ++i, ++next_)
      for (std::size_t d = 0; d < n_; ++d) u_.push_back(draw(d));
    g_ = values_at(u_);
    chains_ = size_;
  }

  // Draws the samples of the next level by Markov chains that start at all samples below the threshold. Samples first[i], first[chains +
  // i], … form chain i.
  void go_on(const Threshold& level) {
    std::vector<double> u, g;
    for (std::size_t i = 0; i < size_; ++i) {
      if (!(g_[i] < level.g)) continue;
      u.insert(u.end(), &u_[i * n_], &u_[i * n_] + n_);
      g.push_back(g_[i]);
    }
    chains_ = level.below;
    while (g.size() < size_) {
      const std::size_t from = g.size() - chains_, count = std::min(chains_, size_ - g.size());
      const double stay = std::sqrt(1.0 - width_ * width_);
      std::vector<double> tried;
      for (std::size_t i = 0; i < count; ++i, ++next_)
        for (std::size_t d = 0; d < n_; ++d) tried.push_back(stay * u[(from + i) * n_ + d] + width_ * draw(d));
      const std::vector<double> values = values_at(tried);
      double taken = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        const bool is_in = values[i] < level.g;
        taken += is_in;
        const std::vector<double>& source = is_in ? tried : u;
        const std::size_t place = is_in ? i : from + i;
        const std::vector<double> next(&source[place * n_], &source[place * n_] + n_);
        u.insert(u.end(), next.begin(), next.end());
        g.push_back(is_in ? values[i] : g[from + i]);
      }
      // Adapts the step of the proposal to an acceptance rate of 44 %, which mixes fastest.
      width_ = std::clamp(width_ * std::exp(0.5 * (taken / static_cast<double>(count) - 0.44)), 0.05, 1.0);
    }
    u_ = std::move(u);
    g_ = std::move(g);
  }

  // Returns the squared coefficient of variation of the fraction below the threshold, including the correlation within chains (γ of Au and
  // Beck).
  [[nodiscard]] double variation(double threshold, double share) const {
    if (share >= 1.0) return 0.0;
    const std::size_t length = size_ / chains_;
    double gamma = 0.0;
    for (std::size_t lag = 1; lag < length; ++lag) {
      double products = 0.0, pairs = 0.0;
      for (std::size_t k = 0; k + lag < length; ++k)
        for (std::size_t i = 0; i < chains_; ++i, ++pairs)
          products += g_[k * chains_ + i] < threshold && g_[(k + lag) * chains_ + i] < threshold;
      const double correlation = (products / pairs - share * share) / (share * (1.0 - share));
      gamma += 2.0 * (1.0 - static_cast<double>(lag) / static_cast<double>(length)) * std::max(0.0, correlation);
    }
    return (1.0 - share) / (share * static_cast<double>(size_)) * (1.0 + gamma);
  }

  LimitFunction& limit_;
  bool is_bad_unsafe_;
  std::size_t n_, size_;
  CounterRandom random_;
  std::uint64_t next_ = 0;
  std::vector<double> u_, g_;
  std::size_t chains_ = 0;
  double width_ = 0.7;
};

Share with_test(double p, double cov, const Interval& interval, const Interval& test) { return {p, cov * p, interval, test}; }

// Returns the mean of all repetitions. Its interval is computed for the logarithm, because the probabilities differ by factors.
Share mean_of(const std::vector<Repetition>& all, const SamplingTarget& target) {
  Share nothing;
  nothing.interval = nothing.test = {0.0, 1.0};
  const double n = static_cast<double>(all.size());
  double least = 1.0, mean = 0.0;
  for (const Repetition& r : all) mean += r.probability / n, least = std::min(least, r.probability);
  if (least <= 0.0 || all.size() < 2) {
    nothing.p = mean;
    return nothing;
  }
  if (std::all_of(all.begin(), all.end(), [](const Repetition& r) { return r.samples > 0; })) {
    double failures = 0.0, samples = 0.0;
    for (const Repetition& r : all) failures += static_cast<double>(r.failures), samples += static_cast<double>(r.samples);
    return with_test(failures / samples, std::sqrt((1.0 - failures / samples) / failures),
                     proportion_interval(failures, samples, target.confidence),
                     proportion_interval(failures, samples, target.test_confidence));
  }
  double squares = 0.0, inner = 0.0;
  for (const Repetition& r : all) {
    squares += (r.probability - mean) * (r.probability - mean);
    inner += std::pow(r.cov * r.probability, 2) / n; // mean variance within a repetition
  }
  const double cov = std::sqrt(std::max(squares / (n - 1.0), inner) / n) / mean;
  const auto interval = [&](double confidence) {
    const double half = student_quantile(n - 1.0, 0.5 * (1.0 + confidence)) * cov;
    return Interval{mean * std::exp(-half), std::min(1.0, mean * std::exp(half))};
  };
  return with_test(mean, cov, interval(target.confidence), interval(target.test_confidence));
}

// Adds the problems of repetitions without a result. If all have none, the estimate is zero with bounds 0 and 1, which is valid. If only
// some have none, the mean of the others is biased, so the estimate is not trusted.
void add_problems(const std::vector<Repetition>& all, Estimate& e) {
  const auto failed = std::count_if(all.begin(), all.end(), [](const Repetition& r) { return !r.problem.empty(); });
  if (failed == 0) return;
  const auto first = std::find_if(all.begin(), all.end(), [](const Repetition& r) { return !r.problem.empty(); });
  e.status = std::to_string(failed) + " of " + std::to_string(all.size()) + " repetitions have no result: " + first->problem;
  e.is_target_met = false;
  e.is_trusted = e.is_trusted && failed == static_cast<long>(all.size());
}

} // namespace

Estimate subset_simulation(LimitFunction& limit, const SamplingTarget& target) {
  const Study& study = limit.run().study();
  SamplingCourse course(limit, target);
  const long bad = limit.bad();
  std::vector<Repetition> unsafe, safe;
  for (long k = 0; k < limit.settings().repetitions && (k == 0 || !course.is_late()); ++k)
    unsafe.push_back(Chains(limit, study.failed != "safe", k).run());
  Estimate e;
  e.bad = limit.bad() - bad;
  if (e.bad > 0 && study.failed == "bounds")
    for (long k = 0; k < static_cast<long>(unsafe.size()); ++k) safe.push_back(Chains(limit, false, k).run());
  const auto is_counted = [](const Repetition& r) { return r.is_counted; };
  if (std::any_of(unsafe.begin(), unsafe.end(), is_counted) || std::any_of(safe.begin(), safe.end(), is_counted)) {
    SamplingTarget rest = target;
    rest.samples = std::max(target.samples - course.used(), target.samples / 2);
    e = monte_carlo(limit, rest);
    e.method = "subset";
    e.status +=
        std::string(e.status.empty() ? "" : "; ") + "most samples have one value, so that no level lies between: failures were counted";
    e.samples = course.used();
    return e;
  }
  e.method = "subset";
  const Share high = mean_of(unsafe, target), low = safe.empty() ? high : mean_of(safe, target);
  course.set(e, low, high);
  e.cov = std::max(e.cov, high.p > 0.0 ? high.deviation / std::min(high.p, 1.0 - high.p) : e.cov);
  e.is_target_met = e.cov <= target.cov;
  if (!e.is_target_met) {
    char text[120];
    std::snprintf(text, sizeof text, "%zu repetitions: coefficient of variation %.3g, %.3g was asked for", unsafe.size(), e.cov,
                  target.cov);
    e.status = text;
  }
  add_problems(unsafe, e);
  add_problems(safe, e);
  return e;
}

} // namespace steplap::study
