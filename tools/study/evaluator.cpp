#include "tools/study/evaluator.h"

#include <omp.h>

#include <chrono>
#include <cmath>
#include <cstring>

namespace steplap::study {

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Serialises outcomes for transfer to rank 0. All ranks run the same program on the same kind of computer.
void pack(const Outcome& o, std::vector<char>& bytes) {
  const auto add = [&bytes](const void* data, std::size_t size) {
    const char* first = static_cast<const char*>(data);
    bytes.insert(bytes.end(), first, first + size);
  };
  const long head[] = {static_cast<long>(o.status), static_cast<long>(o.reason.size()), static_cast<long>(o.numbers.size()),
                       static_cast<long>(o.curve.size())};
  const double costs[] = {o.error, o.evaluations, o.cpu_seconds};
  add(head, sizeof head);
  add(costs, sizeof costs);
  add(o.reason.data(), o.reason.size());
  add(o.numbers.data(), o.numbers.size() * sizeof(double));
  add(o.curve.data(), o.curve.size() * sizeof(double));
}

const char* unpack(const char* bytes, Outcome& o) {
  const auto take = [&bytes](void* data, std::size_t size) {
    std::memcpy(data, bytes, size);
    bytes += size;
  };
  long head[4];
  double costs[3];
  take(head, sizeof head);
  take(costs, sizeof costs);
  o.status = static_cast<SampleStatus>(head[0]);
  o.error = costs[0];
  o.evaluations = costs[1];
  o.cpu_seconds = costs[2];
  o.reason.assign(bytes, static_cast<std::size_t>(head[1]));
  bytes += head[1];
  o.numbers.resize(static_cast<std::size_t>(head[2]));
  take(o.numbers.data(), o.numbers.size() * sizeof(double));
  o.curve.resize(static_cast<std::size_t>(head[3]));
  take(o.curve.data(), o.curve.size() * sizeof(double));
  return bytes;
}

// Returns true if both values are equal or both NaN. −0 equals 0, because the store does not distinguish them.
bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

} // namespace

// One simulator per thread.
class Workers {
public:
  Workers(const LoadedStudy& loaded, int threads) : width_(loaded.study.variables.size()), has_models_(!loaded.models.empty()) {
    const int count = threads > 0 ? threads : omp_get_max_threads();
    for (int i = 0; i < count; ++i) scenes_.push_back(std::make_unique<SampleSimulator>(loaded));
  }

  /// Runs the points first, first + stride, first + 2 stride, …, on all threads.
  void run(const double* points, std::size_t count, std::size_t first, std::size_t stride,
           const std::function<Outcome&(std::size_t)>& outcome) {
    const long mine = first < count ? static_cast<long>((count - first + stride - 1) / stride) : 0;
    const int block = has_models_ ? 1 : 256;
    const bool is_worth_it = has_models_ ? mine > 1 : mine > 2000; // starting threads takes several microseconds, a formula one
#pragma omp parallel for schedule(dynamic, block) num_threads(static_cast<int>(scenes_.size())) if (is_worth_it)
    for (long i = 0; i < mine; ++i) {
      const std::size_t k = first + static_cast<std::size_t>(i) * stride;
      scenes_[static_cast<std::size_t>(omp_get_thread_num())]->run(points + k * width_, outcome(k));
    }
  }

  /// Returns true if all numbers defined by formulas agree with these formulas.
  [[nodiscard]] bool is_derived(const StoredSample& sample) { return scenes_.front()->is_derived(sample.values, sample.outcome); }

private:
  std::vector<std::unique_ptr<SampleSimulator>> scenes_;
  std::size_t width_;
  bool has_models_;
};

Evaluator::Evaluator(const LoadedStudy& loaded, Store& store, const Ranks& ranks, int threads, std::function<void(const Pace&)> progress)
    : loaded_(loaded), writer_(store), stored_(store.size()), ranks_(ranks), workers_(std::make_unique<Workers>(loaded, threads)),
      progress_(std::move(progress)), chunk_(loaded.models.empty() ? 10000 : 16 * static_cast<std::size_t>(ranks.count())), begin_(now()) {}

Evaluator::~Evaluator() = default;

double Evaluator::seconds() const { return now() - begin_; }

void Evaluator::fetch(std::size_t from, std::size_t count, const std::vector<double>& points) {
  const std::size_t width = loaded_.study.variables.size();
  Store& store = writer_.store();
  store.read(next_ + static_cast<long>(from), static_cast<long>(count), fetched_);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < width; ++j)
      if (!is_same(fetched_[i].values[j],
                   points[(from + i) * width + j])) { // the stored samples of a changed study differ from here on
        if (!may_go_another_way(store))
          throw StoreError(store.path(),
                           "the store is damaged, or was edited: sample " + std::to_string(fetched_[i].number) +
                               " has other values than the study: let it create the store again",
                           {StoreMode::restart});
        store.forget_from(fetched_[i].number);
        stored_ = store.size();
        return;
      }
    if (!workers_->is_derived(fetched_[i]))
      throw StoreError(store.path(),
                       "the store is damaged, or was edited: sample " + std::to_string(fetched_[i].number) +
                           " has numbers that do not follow from its values and responses: let the study create the store again",
                       {StoreMode::restart});
    rows_[from + i] = std::move(fetched_[i]);
    ++pace_.stored;
  }
}

// Returns true if the samples requested may differ from the stored ones without an error: the study was changed, or a time limit ends it.
bool Evaluator::may_go_another_way(Store& store) const { return store.may_hold_others() || loaded_.study.settings->ends_by_clock(); }

void Evaluator::run(std::size_t from, std::size_t count, const std::vector<double>& points) {
  const std::size_t width = loaded_.study.variables.size();
  std::vector<double> part(points.begin() + static_cast<long>(from * width), points.begin() + static_cast<long>((from + count) * width));
  for (std::size_t i = 0; i < count; ++i) {
    rows_[from + i].number = next_ + static_cast<long>(from + i);
    rows_[from + i].values.assign(part.begin() + static_cast<long>(i * width), part.begin() + static_cast<long>((i + 1) * width));
  }
  ranks_.spread(part);
  const auto stride = static_cast<std::size_t>(ranks_.count());
  workers_->run(part.data(), count, 0, stride, [&](std::size_t i) -> Outcome& { return rows_[from + i].outcome; });
  if (stride > 1) {
    const std::vector<std::vector<char>> all = ranks_.gather({});
    for (std::size_t r = 1; r < stride; ++r) {
      const char* bytes = all[r].data();
      for (std::size_t i = r; i < count; i += stride) bytes = unpack(bytes, rows_[from + i].outcome);
    }
  }
  if (const std::string record = loaded_.changed_record(); !record.empty())
    throw StoreError(record, "'" + record + "' has changed while the study ran: what was run since is not kept; run it again");
  const auto first = rows_.begin() + static_cast<long>(from), last = first + static_cast<long>(count);
  writer_.append({first, last});
  stored_ += static_cast<long>(count);
}

void Evaluator::check(const StoredSample& sample) const {
  if (loaded_.study.failed != "stop" || sample.outcome.status == SampleStatus::ok) return;
  throw StudyStopped("sample " + std::to_string(sample.number) + " " + name_of(sample.outcome.status) + ": " + sample.outcome.reason +
                     " (the study says failed = \"stop\")");
}

// Batches take about half a second, which limits the loss at an interruption. Stored data do not depend on the batch size.
const std::vector<StoredSample>& Evaluator::evaluate(const std::vector<double>& points) {
  constexpr double k_batch = 0.5; // target duration of a batch, s
  const std::size_t width = loaded_.study.variables.size(), count = width ? points.size() / width : 0;
  rows_.resize(count);
  for (std::size_t from = 0; from < count;) {
    const long there = stored_ - (next_ + static_cast<long>(from)) + 1;
    std::size_t part = std::min(count - from, chunk_);
    if (there > 0) {
      part = std::min(part, static_cast<std::size_t>(there));
      const long stored = pace_.stored;
      fetch(from, part, points);
      part = static_cast<std::size_t>(pace_.stored - stored);
    } else {
      const double begin = now();
      run(from, part, points);
      const double took = std::max(now() - begin, 1e-6);
      pace_.rate = static_cast<double>(part) / took;
      const auto least = static_cast<std::size_t>(ranks_.count());
      chunk_ = std::clamp(static_cast<std::size_t>(k_batch * pace_.rate), least, std::min<std::size_t>(200000, 4 * chunk_ + least));
    }
    for (std::size_t i = 0; i < part; ++i) check(rows_[from + i]);
    from += part;
    pace_.samples = next_ - 1 + static_cast<long>(from);
    pace_.seconds = seconds();
    if (progress_) progress_(pace_);
  }
  next_ += static_cast<long>(count);
  return rows_;
}

void Evaluator::note(const Finding& finding) {
  writer_.note(++notes_, finding);
  char text[120];
  std::snprintf(text, sizeof text, "%s %.4g [%.4g, %.4g]", finding.quantity.c_str(), finding.value, finding.low, finding.high);
  pace_.estimate = finding.method + ": " + text;
}

void Evaluator::expect(long more, bool is_guess) {
  pace_.expected = more > 0 ? asked() + more : 0;
  pace_.is_guess = is_guess;
}

void Evaluator::serve(const LoadedStudy& loaded, const Ranks& ranks, int threads) {
  Workers workers(loaded, threads);
  const std::size_t width = loaded.study.variables.size();
  std::vector<double> points;
  std::vector<Outcome> outcomes;
  for (ranks.spread(points); !points.empty(); ranks.spread(points)) {
    const std::size_t count = points.size() / width, stride = static_cast<std::size_t>(ranks.count());
    outcomes.resize(count);
    workers.run(points.data(), count, static_cast<std::size_t>(ranks.rank()), stride,
                [&](std::size_t i) -> Outcome& { return outcomes[i]; });
    std::vector<char> bytes;
    for (std::size_t i = static_cast<std::size_t>(ranks.rank()); i < count; i += stride) pack(outcomes[i], bytes);
    (void)ranks.gather(bytes);
  }
}

void Evaluator::dismiss(const Ranks& ranks) {
  std::vector<double> nothing;
  ranks.spread(nothing);
}

} // namespace steplap::study
