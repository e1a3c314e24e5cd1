// Active learning with kriging (AK-MCS: B. Echard, N. Gayton, M. Lemaire, Structural Safety 33, 2011), for runs that are dear. A population
// of samples is drawn as by crude Monte Carlo, but few of them are run: a surrogate says whether the others fail, and runs are made where it
// is in doubt.
//
// The interval has two parts. Samples of which the surrogate is in doubt count as holding at its lower end and as failing at its upper one.
// Both ends have the scatter of the population (Clopper and Pearson). A surrogate can be sure and wrong far from all runs. Therefore samples
// there are run before the answer is believed, and learning continues if one of them contradicts it.
#include "mbd/base/shown_text.h"
#include "tools/study/sampling_course.h"
#include "tools/study/surrogate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap::study {

namespace {

using Indices = std::vector<std::size_t>;

constexpr double k_sure = 2.0;     // standard deviations from zero: the sign is wrong with a probability of 2.3 %
constexpr std::size_t k_batch = 3; // runs at a time, which use several processors
constexpr std::size_t k_first_population = 10000, k_largest_population = 1000000;
constexpr long k_most_runs = 500; // surrogates of more cost more than they save

SamplingTarget few_runs(SamplingTarget target) {
  target.samples = std::min(target.samples, k_most_runs);
  return target;
}

class Kriging {
public:
  Kriging(LimitFunction& limit, const SamplingTarget& target)
      : limit_(limit), n_(limit.dimension()), target_(few_runs(target)), course_(limit, target_),
        random_(static_cast<std::uint64_t>(limit.run().study().seed), k_stream), surrogate_(n_) {
    e_.method = "kriging";
  }

  Estimate estimate() {
    extend(k_first_population);
    run(far_samples(std::max<std::size_t>(12, 3 * n_)));
    try {
      learn();
    } catch (const std::runtime_error& error) {
      distrust(error.what());
    }
    conclude();
    return e_;
  }

private:
  [[nodiscard]] std::size_t size() const { return population_.size() / n_; }
  [[nodiscard]] const double* sample(std::size_t i) const { return &population_[i * n_]; }

  void extend(std::size_t count) {
    for (std::size_t i = size(); i < count; ++i)
      for (std::size_t d = 0; d < n_; ++d) population_.push_back(random_.normal(i, static_cast<std::uint32_t>(d)));
  }

  [[nodiscard]] std::vector<double> points_of(const Indices& which) const {
    std::vector<double> points;
    for (const std::size_t i : which) points.insert(points.end(), sample(i), sample(i) + n_);
    return points;
  }

  [[nodiscard]] double square_distance(std::size_t i, std::size_t k) const {
    double sum = 0.0;
    for (std::size_t d = 0; d < n_; ++d) sum += std::pow(sample(i)[d] - sample(k)[d], 2);
    return sum;
  }

  // Returns samples that are far from all that were run and from each other: repeatedly the farthest.
  [[nodiscard]] Indices far_samples(std::size_t count) const {
    std::vector<double> nearest(size(), std::numeric_limits<double>::infinity());
    const auto keep_off = [&](std::size_t k) {
      for (std::size_t i = 0; i < size(); ++i) nearest[i] = std::min(nearest[i], square_distance(i, k));
    };
    for (const std::size_t k : asked_) keep_off(k);
    Indices far;
    while (far.size() < count) {
      far.push_back(static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin()));
      keep_off(far.back());
    }
    return far;
  }

  // Runs samples as far as the budget allows. Returns true if the surrogate was sure of one and wrong.
  bool run(Indices which) {
    which.resize(std::min(which.size(), static_cast<std::size_t>(std::max(0L, course_.left()))));
    if (which.empty()) return false;
    const std::vector<LimitValue>& values = limit_.at(points_of(which));
    bool is_contradicted = false;
    for (std::size_t k = 0; k < which.size(); ++k) {
      const std::size_t i = which[k];
      asked_.push_back(i);
      e_.bad += values[k].is_missing;
      if (values[k].is_missing) continue;
      known_.push_back(i);
      g_.push_back(values[k].g);
      if (i < predictions_.size() && predictions_[i].certainty() >= k_sure)
        is_contradicted = is_contradicted || (predictions_[i].mean < 0.0) != (values[k].g < 0.0);
    }
    return is_contradicted;
  }

  void fit() {
    if (e_.bad > 0) throw std::runtime_error("a run gave no result, and a surrogate cannot say how many others give none");
    surrogate_.fit(points_of(known_), g_);
  }

  // Fits the surrogate and asks it about the whole population.
  void survey() {
    fit();
    predictions_ = surrogate_.at(population_);
    failing_ = doubtful_ = sure_ = 0;
    for (const Prediction& p : predictions_) {
      const bool is_failing = p.mean < 0.0, is_sure = p.certainty() >= k_sure;
      failing_ += is_failing;
      doubtful_ += !is_sure;
      sure_ += is_failing && is_sure;
    }
    set();
    course_.note(e_);
  }

  void set() {
    const double count = static_cast<double>(size()), p = static_cast<double>(failing_) / count;
    const auto interval = [&](double confidence) {
      return Interval{proportion_interval(static_cast<double>(sure_), count, confidence).low,
                      proportion_interval(static_cast<double>(sure_ + doubtful_), count, confidence).high};
    };
    const Share share{p, std::sqrt(p * (1.0 - p) / count), interval(target_.confidence), interval(target_.test_confidence)};
    course_.set(e_, share, share);
  }

  // Doubts must widen the interval by little.
  [[nodiscard]] bool is_clear() const {
    constexpr double k_little = 0.2; // of a standard deviation of the probability
    return static_cast<double>(doubtful_) <=
           k_little * target_.cov * static_cast<double>(std::min(failing_, static_cast<long>(size()) - failing_));
  }

  void learn() {
    constexpr std::size_t k_checks = 5;
    for (survey(); !course_.is_over(); survey()) {
      if (!is_clear()) ask_where_in_doubt();
      else if (is_to_grow()) extend(grown_size());
      else if (!run(far_samples(k_checks))) {
        is_checked_ = true;
        return;
      }
    }
  }

  [[nodiscard]] bool is_to_grow() const { return !(e_.cov <= target_.cov) && size() < k_largest_population; }

  [[nodiscard]] std::size_t grown_size() const {
    constexpr double k_most = 10.0, k_margin = 1.1; // so that an underestimated scatter seldom requires another step
    const double times = std::isfinite(e_.cov) ? std::min(k_most, k_margin * std::pow(e_.cov / target_.cov, 2)) : k_most;
    return std::min(k_largest_population, static_cast<std::size_t>(std::ceil(times * static_cast<double>(size()))));
  }

  // Learns from the most doubtful samples alone before the whole population is asked again, which takes longer.
  void ask_where_in_doubt() {
    constexpr std::size_t k_candidates = 500;
    constexpr int k_rounds = 10;
    Indices candidates(size());
    std::iota(candidates.begin(), candidates.end(), std::size_t{0});
    const auto end = candidates.begin() + static_cast<long>(std::min(k_candidates, size()));
    const auto is_less_sure = [&](std::size_t a, std::size_t b) { return predictions_[a].certainty() < predictions_[b].certainty(); };
    std::partial_sort(candidates.begin(), end, candidates.end(), is_less_sure);
    candidates.erase(end, candidates.end());
    for (int round = 0; round < k_rounds && !course_.is_over(); ++round) {
      const Indices batch = most_doubtful(candidates);
      if (batch.empty()) return;
      (void)run(batch);
      fit();
      const std::vector<Prediction> predictions = surrogate_.at(points_of(candidates));
      for (std::size_t k = 0; k < candidates.size(); ++k) predictions_[candidates[k]] = predictions[k];
      std::stable_sort(candidates.begin(), candidates.end(), is_less_sure);
    }
  }

  // Returns the doubtful samples of which the surrogate is least sure. What it does not know at one of them must say little of the others.
  [[nodiscard]] Indices most_doubtful(const Indices& candidates) const {
    constexpr double k_related = 0.5; // correlation
    Indices batch;
    for (const std::size_t i : candidates) {
      if (batch.size() == k_batch || predictions_[i].certainty() >= k_sure) break;
      if (std::none_of(batch.begin(), batch.end(), [&](std::size_t k) { return surrogate_.correlation(sample(i), sample(k)) > k_related; }))
        batch.push_back(i);
    }
    return batch;
  }

  void distrust(const std::string& why) {
    e_.status = why;
    e_.safe = e_.unsafe = std::nan("");
    e_.is_trusted = false;
  }

  void conclude() {
    if (!e_.is_trusted) return;
    course_.say_why_it_ended(e_);
    e_.is_target_met = e_.is_target_met && is_checked_;
    const std::string population = counted(size(), "sample", "samples");
    if (!is_checked_) e_.status = "all runs used: the surrogate is in doubt about " + std::to_string(doubtful_) + " of " + population;
    else if (failing_ == 0) e_.status = "no failure among " + population + ": only a bound is known";
    const auto share = [&](long count) { return static_cast<double>(count) / static_cast<double>(size()); };
    e_.more = {{"kriging", limit_.subject(), "population", static_cast<double>(size())},
               {"kriging", limit_.subject(), "with doubtful samples as safe", share(sure_)},
               {"kriging", limit_.subject(), "with doubtful samples as failures", share(sure_ + doubtful_)}};
  }

  static constexpr std::uint32_t k_stream = 13;
  LimitFunction& limit_;
  std::size_t n_;
  SamplingTarget target_;
  SamplingCourse course_;
  CounterRandom random_;
  Surrogate surrogate_;
  Estimate e_;
  std::vector<double> population_; ///< coordinates, one sample after the other
  Indices asked_, known_;          ///< samples that were run; those with a result
  std::vector<double> g_;          ///< results
  std::vector<Prediction> predictions_;
  long failing_ = 0, sure_ = 0, doubtful_ = 0; ///< of the population: the mean is negative; surely; the sign is in doubt
  bool is_checked_ = false;                    ///< true if samples far from all runs have confirmed the surrogate
};

} // namespace

Estimate kriging(LimitFunction& limit, const SamplingTarget& target) { return Kriging(limit, target).estimate(); }

} // namespace steplap::study
