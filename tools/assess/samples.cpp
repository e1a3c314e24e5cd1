#include "tools/assess/samples.h"

#include "tools/assess/sample_store.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <numeric>

namespace steplap::assess {

namespace {

struct ThreadRunners {
  std::vector<std::unique_ptr<VoyageRunner>> of_models;
  const std::vector<std::vector<DriveHistory>>& histories; ///< indexed by model and event
  const std::vector<SharedFriction>& shared;
};

ThreadRunners runners_of(const std::vector<DrivenModel>& models, const std::vector<std::vector<DriveHistory>>& histories,
                         const std::vector<SharedFriction>& shared, const UncertainValues& uncertain) {
  ThreadRunners runners{{}, histories, shared};
  for (std::size_t m = 0; m < models.size(); ++m)
    runners.of_models.push_back(std::make_unique<VoyageRunner>(models[m], histories[m], uncertain.paths(m)));
  return runners;
}

// Evaluates the shared frictions for the events that were simulated in all models.
void judge_planes(const ThreadRunners& runners, const std::vector<VoyageOutcome>& outcomes, VoyageSummary& summary) {
  std::size_t events = outcomes.front().events_made;
  for (const VoyageOutcome& outcome : outcomes) events = std::min(events, outcome.events_made);
  SharedFrictions frictions(runners.shared);
  const std::vector<SampledFriction> none;
  for (std::size_t e = 0; e < events; ++e) {
    std::vector<const std::vector<SampledFriction>*> traces;
    std::vector<const DriveHistory*> histories;
    for (std::size_t m = 0; m < outcomes.size(); ++m) {
      traces.push_back(e < outcomes[m].traces.size() ? &outcomes[m].traces[e] : &none);
      histories.push_back(&runners.histories[m][e]);
    }
    for (const SharedPassage& passage : frictions.pass(traces, histories))
      add_to(summary, runners.shared[passage.friction], passage, e + 1);
  }
}

void run(ThreadRunners& runners, const UncertainValues& uncertain, VoyageSample& sample, const std::function<bool()>& stop) {
  std::vector<VoyageOutcome> outcomes;
  for (std::size_t m = 0; m < runners.of_models.size(); ++m) {
    VoyageOutcome outcome = runners.of_models[m]->run(uncertain.numbers(m, sample.values), stop);
    worsen(sample.summary, outcome.summary);
    sample.slips.insert(sample.slips.end(), outcome.slips.begin(), outcome.slips.end());
    if (!runners.shared.empty()) outcomes.push_back(std::move(outcome));
  }
  if (!outcomes.empty()) judge_planes(runners, outcomes, sample.summary);
}

Probability probability(long harmful, long unknown, long runs) {
  Probability p;
  p.runs = runs, p.unknown = unknown;
  if (runs == 0) return p;
  constexpr double k_confidence = 0.95;
  p.value = runs > unknown ? static_cast<double>(harmful) / static_cast<double>(runs - unknown) : std::nan("");
  p.low = study::proportion_interval(static_cast<double>(harmful), static_cast<double>(runs), k_confidence).low;
  p.high = study::proportion_interval(static_cast<double>(harmful + unknown), static_cast<double>(runs), k_confidence).high;
  return p;
}

// Ranks in the order of the values; equal values share their mean rank.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size()), ma = std::accumulate(a.begin(), a.end(), 0.0) / n,
               mb = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    aa += (a[i] - ma) * (a[i] - ma), bb += (b[i] - mb) * (b[i] - mb), ab += (a[i] - ma) * (b[i] - mb);
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

Verdict acceptance_of(const VoyageSummary& s, LimitsJudged limits) {
  return limits == LimitsJudged::all ? s.limits.outcome : s.known_limits.outcome;
}

// Collects samples from several threads and stores them. Only the samples up to the first missing one can be stored, every half second.
class VoyageCourse {
public:
  VoyageCourse(const SamplingOptions& options, SampleStore& store, std::vector<VoyageSample>& samples)
      : options_(options), store_(store), samples_(samples), is_made_(samples.size()), done_(store.load(samples)), kept_(done_) {
    if (options_.progress) options_.progress(done_, options_.samples);
  }

  /// Returns the number of samples before the first missing one.
  [[nodiscard]] long done() const { return done_; }

  /// Simulates sample n on the calling thread, unless the work was stopped. Exceptions are kept for end().
  void make(long n, const std::function<void(VoyageSample&, const std::function<bool()>&)>& run) {
    try {
      if (should_stop()) return;
      run(samples_[static_cast<std::size_t>(n)], [this] { return should_stop(); });
      if (!should_stop()) add(n); // an interrupted voyage is discarded
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      is_ended_ = true;
    }
  }

  /// Stores the remaining samples. Throws exceptions of the threads, and NumericalFailure if stopped.
  void end() {
    keep();
    if (failure_) std::rethrow_exception(failure_);
    if (done_ == options_.samples) return;
    throw NumericalFailure(why_ + " after " + std::to_string(done_) + " of " + std::to_string(options_.samples) + " samples." +
                           (options_.store.empty() ? "" : " Repeat the command to continue."));
  }

private:
  using Clock = std::chrono::steady_clock;

  bool should_stop() {
    if (is_ended_ || !options_.stop) return is_ended_;
    const std::string why = options_.stop();
    if (why.empty()) return false;
    const std::scoped_lock lock(mutex_);
    why_ = why;
    is_ended_ = true;
    return true;
  }
  void add(long n) {
    const std::scoped_lock lock(mutex_);
    is_made_[static_cast<std::size_t>(n)] = true;
    const long before = done_;
    while (done_ < options_.samples && is_made_[static_cast<std::size_t>(done_)]) ++done_;
    if (done_ > before && options_.progress) options_.progress(done_, options_.samples);
    if (Clock::now() - last_ > std::chrono::milliseconds(500)) keep();
  }
  void keep() {
    if (done_ > kept_) store_.append(samples_, kept_, done_);
    kept_ = done_;
    last_ = Clock::now();
  }

  const SamplingOptions& options_;
  SampleStore& store_;
  std::vector<VoyageSample>& samples_;
  std::mutex mutex_; ///< protects everything below while threads run
  std::vector<bool> is_made_;
  long done_, kept_;
  Clock::time_point last_ = Clock::now();
  std::string why_; ///< reason of a stop
  std::exception_ptr failure_;
  std::atomic<bool> is_ended_ = false;
};

} // namespace

VoyageSample voyage_with(const std::vector<DrivenModel>& models, const std::vector<std::vector<DriveHistory>>& histories,
                         const UncertainValues& uncertain, const std::vector<double>& values, const std::vector<SharedFriction>& shared) {
  ThreadRunners runners = runners_of(models, histories, shared, uncertain);
  VoyageSample sample;
  sample.values = values;
  run(runners, uncertain, sample, {});
  return sample;
}

std::vector<VoyageSample> sample_voyages(const std::vector<DrivenModel>& models, const std::vector<std::vector<DriveHistory>>& histories,
                                         const UncertainValues& uncertain, const SamplingOptions& options,
                                         const std::vector<SharedFriction>& shared) {
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  std::vector<VoyageSample> samples(static_cast<std::size_t>(std::max(0L, options.samples)));
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n].values = uncertain.draw(options.seed, n + 1);
  SampleStore store(options, models, histories, uncertain);
  VoyageCourse course(options, store, samples);
  std::vector<ThreadRunners> teams; // created by one thread, because reading and completing models is not thread-safe
  for (int i = 0; i < threads; ++i) teams.push_back(runners_of(models, histories, shared, uncertain));
    // Samples are distributed singly, so that threads do not wait for the longest voyage of a batch.
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (long n = course.done(); n < options.samples; ++n)
    course.make(n, [&](VoyageSample& sample, const std::function<bool()>& stop) {
      run(teams[static_cast<std::size_t>(omp_get_thread_num())], uncertain, sample, stop);
    });
  course.end();
  return samples;
}

bool is_damaged(const VoyageSummary& s, LimitsJudged limits) {
  return s.slips || s.comes_apart || acceptance_of(s, limits) >= Verdict::inspect;
}

Probability slip_probability(const std::vector<VoyageSample>& samples, std::size_t model, std::size_t event, std::size_t events) {
  long slips = 0, unknown = 0;
  for (const VoyageSample& sample : samples) {
    if (sample.slips[model * events + event] != 0) ++slips;
    else if (!sample.summary.unknown.empty()) ++unknown;
  }
  return probability(slips, unknown, static_cast<long>(samples.size()));
}

Probability damage_probability(const std::vector<VoyageSample>& samples, LimitsJudged limits) {
  long damaged = 0, unknown = 0;
  for (const VoyageSample& sample : samples) {
    if (is_damaged(sample.summary, limits)) ++damaged; // counts even if the voyage could not be completed afterwards
    else if (!sample.summary.unknown.empty() || acceptance_of(sample.summary, limits) == Verdict::open ||
             sample.summary.planes != Verdict::hold)
      ++unknown;
  }
  return probability(damaged, unknown, static_cast<long>(samples.size()));
}

std::vector<double> shares_of(const std::vector<VoyageSample>& samples) {
  std::vector<double> margins;
  std::vector<std::vector<double>> values;
  for (const VoyageSample& sample : samples) {
    if (!sample.summary.unknown.empty() || !std::isfinite(sample.summary.least_margin)) continue;
    margins.push_back(sample.summary.least_margin);
    values.resize(sample.values.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i].push_back(sample.values[i]);
  }
  std::vector<double> shares;
  if (margins.size() < 3) return shares;
  const std::vector<double> ranks = ranks_of(margins);
  for (const std::vector<double>& of : values) {
    const double r = correlation(ranks_of(of), ranks);
    shares.push_back(r * r);
  }
  return shares;
}

} // namespace steplap::assess
