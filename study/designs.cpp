// Sweeps and samples: studies that say nothing of failure by themselves.
#include "study/designs.h"

#include "mbd/base/number_text.h"
#include "study/counter_random.h"

#include <openturns/HaltonSequence.hxx>
#include <openturns/SobolSequence.hxx>

#include <cmath>
#include <memory>
#include <numeric>

namespace steplap::study {

namespace {

constexpr std::size_t k_block = 10000; // samples asked for at once: memory does not grow with their number

// The values a variable is swept over.
std::vector<double> levels_of(const StudyRun& run, std::size_t i) {
  const Variable& v = run.study().variables[i];
  if (!v.values.empty()) return v.values;
  const auto& random = run.law.random();
  const auto found = std::find(random.begin(), random.end(), i);
  if (found == random.end()) return {run.law.nominal()[i]};
  const auto n = static_cast<std::size_t>(run.study().sweep.points);
  std::vector<double> levels;
  for (std::size_t k = 0; k < n; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(n - 1);
    if (v.has_distribution())
      levels.push_back(run.law.quantile(static_cast<std::size_t>(found - random.begin()), 0.05 + 0.9 * share));
    else levels.push_back(k + 1 == n ? v.range[1] : v.range[0] + share * (v.range[1] - v.range[0]));
  }
  return levels;
}

// The least and the largest of every number, and where.
class Extent {
public:
  explicit Extent(std::size_t count) : low_(count), high_(count) {}

  void add(const StoredSample& sample) {
    ++total_;
    bad_ += sample.outcome.status != SampleStatus::ok;
    for (std::size_t i = 0; i < low_.size(); ++i) {
      const double x = sample.outcome.numbers[i];
      if (std::isnan(x)) continue;
      if (low_[i].number == 0 || x < low_[i].value) low_[i] = {x, sample.number};
      if (high_[i].number == 0 || x > high_[i].value) high_[i] = {x, sample.number};
    }
  }

  void report(const LoadedStudy& loaded, Answer& answer) const {
    const std::vector<std::string> names = loaded.number_names();
    for (std::size_t i = 0; i < low_.size(); ++i)
      for (const bool is_high : {false, true}) {
        const Place& place = is_high ? high_[i] : low_[i];
        Finding f{"sweep", names[i], is_high ? "highest" : "lowest"};
        f.samples = total_;
        if (place.number) f.value = place.value;
        f.status = place.number ? "at sample " + std::to_string(place.number) : "no run gave a value";
        answer.findings.push_back(f);
      }
    if (bad_) {
      answer.notes.push_back(std::to_string(bad_) + " of " + std::to_string(total_) +
                             " runs did not reach their end or are not to be trusted: see the reasons");
      answer.degrade(Standing::not_met);
    }
  }

private:
  struct Place {
    double value = 0.0;
    long number = 0;
  };
  std::vector<Place> low_, high_;
  long total_ = 0, bad_ = 0;
};

class Sweeper {
public:
  explicit Sweeper(StudyRun& run) : run_(run), extent_(run.loaded.number_count()) {}

  void add(const std::vector<double>& point) {
    points_.insert(points_.end(), point.begin(), point.end());
    if (points_.size() >= k_block * point.size()) flush();
  }
  void flush() {
    for (const StoredSample& sample : run_.evaluator.evaluate(points_)) extent_.add(sample);
    points_.clear();
  }
  [[nodiscard]] const Extent& extent() const { return extent_; }

private:
  StudyRun& run_;
  Extent extent_;
  std::vector<double> points_;
};

void sweep_grid(const std::vector<std::vector<double>>& levels, Sweeper& sweeper) {
  std::vector<std::size_t> place(levels.size(), 0);
  std::vector<double> point(levels.size());
  for (bool is_over = false; !is_over;) {
    for (std::size_t i = 0; i < levels.size(); ++i) point[i] = levels[i][place[i]];
    sweeper.add(point);
    is_over = true;
    for (std::size_t i = levels.size(); i-- > 0 && is_over;) { // the last variable runs fastest
      is_over = ++place[i] == levels[i].size();
      if (is_over) place[i] = 0;
    }
  }
}

void sweep_list(const std::vector<std::vector<double>>& levels, Sweeper& sweeper) {
  std::size_t longest = 1;
  for (const auto& list : levels) longest = std::max(longest, list.size());
  for (std::size_t k = 0; k < longest; ++k) {
    std::vector<double> point;
    for (const auto& list : levels) point.push_back(list.size() == 1 ? list[0] : list[k]);
    sweeper.add(point);
  }
}

void sweep_one_at_a_time(const std::vector<std::vector<double>>& levels, const std::vector<double>& nominal,
                         Sweeper& sweeper) {
  sweeper.add(nominal);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    std::vector<double> point = nominal;
    if (levels[i].size() == 1) continue;
    for (const double x : levels[i]) {
      point[i] = x;
      sweeper.add(point);
    }
  }
}

// --- samples ------------------------------------------------------------------------------------

/// Points of the unit cube, in their order.
class Design {
public:
  virtual ~Design() = default;
  virtual void next(std::size_t count, std::vector<double>& uniform) = 0; ///< count points
};

class MonteCarlo : public Design {
public:
  MonteCarlo(std::uint64_t seed, std::size_t dimension) : random_(seed, 1), dimension_(dimension) {}
  void next(std::size_t count, std::vector<double>& uniform) override {
    for (std::size_t i = 0; i < count; ++i, ++sample_)
      for (std::size_t d = 0; d < dimension_; ++d)
        uniform.push_back(random_.uniform(sample_, static_cast<std::uint32_t>(d)));
  }

private:
  CounterRandom random_;
  std::size_t dimension_;
  std::uint64_t sample_ = 0;
};

/// One point in each of as many strata as there are samples, of every variable; strata are paired at random.
class LatinHypercube : public Design {
public:
  LatinHypercube(std::uint64_t seed, std::size_t dimension, std::size_t count)
      : random_(seed, 2), count_(count), strata_(dimension) {
    for (std::size_t d = 0; d < dimension; ++d) {
      strata_[d].resize(count);
      std::iota(strata_[d].begin(), strata_[d].end(), 0U);
      for (std::size_t i = count; i-- > 1;) {
        const double share = random_.uniform(i, static_cast<std::uint32_t>(2 * d));
        std::swap(strata_[d][i], strata_[d][static_cast<std::size_t>(share * static_cast<double>(i + 1))]);
      }
    }
  }
  void next(std::size_t count, std::vector<double>& uniform) override {
    for (std::size_t i = 0; i < count; ++i, ++sample_)
      for (std::size_t d = 0; d < strata_.size(); ++d) {
        const double inside = random_.uniform(sample_, static_cast<std::uint32_t>(2 * d + 1));
        uniform.push_back((static_cast<double>(strata_[d][sample_]) + inside) / static_cast<double>(count_));
      }
  }

private:
  CounterRandom random_;
  std::size_t count_, sample_ = 0;
  std::vector<std::vector<std::uint32_t>> strata_;
};

template <class Sequence> class LowDiscrepancy : public Design {
public:
  explicit LowDiscrepancy(std::size_t dimension) : sequence_(dimension) {}
  void next(std::size_t count, std::vector<double>& uniform) override {
    const OT::Sample points = sequence_.generate(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t d = 0; d < points.getDimension(); ++d) uniform.push_back(points(i, d));
  }

private:
  Sequence sequence_;
};

std::unique_ptr<Design> design_of(const Study& study, std::size_t dimension) {
  const std::string& name = study.sample.design;
  const auto seed = static_cast<std::uint64_t>(study.seed);
  if (name == "latin_hypercube")
    return std::make_unique<LatinHypercube>(seed, dimension, static_cast<std::size_t>(study.sample.samples));
  if (name == "sobol") return std::make_unique<LowDiscrepancy<OT::SobolSequence>>(dimension);
  if (name == "halton") return std::make_unique<LowDiscrepancy<OT::HaltonSequence>>(dimension);
  return std::make_unique<MonteCarlo>(seed, dimension);
}

// Mean and variance as they come in (Welford), of finite values.
struct Moments {
  long count = 0, missing = 0, unknown = 0; ///< missing: infinite (what never happened) or unknown
  double mean = 0.0, squares = 0.0;
  void add(double x) {
    if (!std::isfinite(x)) {
      ++missing;
      unknown += std::isnan(x);
      return;
    }
    const double difference = x - mean;
    mean += difference / static_cast<double>(++count);
    squares += difference * (x - mean);
  }
  [[nodiscard]] double deviation() const {
    return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : std::nan("");
  }
};

class Summary {
public:
  explicit Summary(const LoadedStudy& loaded)
      : loaded_(loaded), moments_(loaded.number_count()), failed_(loaded.study.limit_states.size(), 0) {}

  void add(const StoredSample& sample) {
    ++total_;
    const std::size_t responses = loaded_.study.responses.size();
    const bool is_ok = sample.outcome.status == SampleStatus::ok;
    bad_ += !is_ok;
    for (std::size_t i = 0; i < moments_.size(); ++i) moments_[i].add(sample.outcome.numbers[i]);
    for (std::size_t i = 0; i < failed_.size(); ++i) failed_[i] += is_ok && sample.outcome.numbers[responses + i] < 0.0;
  }

  void report(StudyRun& run, Answer& answer) const {
    const std::string& method = run.study().sample.design;
    const bool is_random = method == "monte_carlo";
    const std::vector<std::string> names = loaded_.number_names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Moments& m = moments_[i];
      const std::string status = m.missing ? std::to_string(m.missing) + " of " + std::to_string(total_) +
                                                 " runs gave no finite value and are left out"
                                           : "";
      Finding mean{method, names[i], "mean", m.count ? m.mean : std::nan("")};
      mean.samples = m.count;
      mean.status = status;
      if (is_random && m.count > 1) {
        const double half = student_quantile(static_cast<double>(m.count - 1), 0.975) * m.deviation() /
                            std::sqrt(static_cast<double>(m.count));
        mean.low = m.mean - half;
        mean.high = m.mean + half;
      }
      answer.findings.push_back(mean);
      Finding deviation{method, names[i], "standard deviation", m.deviation()};
      deviation.samples = m.count;
      deviation.status = status;
      answer.findings.push_back(deviation);
      for (const double p : {0.05, 0.5, 0.95}) answer.findings.push_back(quantile(run, i, p, is_random));
      // Those that are left out are not like the others: what is found of these alone is not what was asked for.
      if (m.unknown > 0) answer.degrade(m.unknown == total_ ? Standing::not_trusted : Standing::not_met);
    }
    if (bad_ > 0) answer.degrade(Standing::not_met);
    report_failures(run, is_random, answer);
  }

private:
  // Of all samples in the store that have a value; its interval is of order statistics.
  Finding quantile(StudyRun& run, std::size_t i, double p, bool is_random) const {
    char text[40];
    std::snprintf(text, sizeof text, "%g %% quantile", 100.0 * p);
    Finding f{run.study().sample.design, loaded_.number_names()[i], text};
    const long n = run.store.count_of(i);
    f.samples = n;
    if (n < total_)
      f.status = std::to_string(total_ - n) + " of " + std::to_string(total_) + " runs gave no value and are left out";
    if (n == 0) return f;
    const auto place = [n](double share) {
      return std::clamp(static_cast<long>(std::floor(share * static_cast<double>(n))), 0L, n - 1);
    };
    f.value = run.store.order_statistic(i, place(p));
    if (!is_random) return f;
    const double half = 1.96 * std::sqrt(p * (1.0 - p) / static_cast<double>(n));
    if (p - half > 0.0) f.low = run.store.order_statistic(i, place(p - half));
    if (p + half < 1.0) f.high = run.store.order_statistic(i, place(p + half));
    return f;
  }

  void report_failures(StudyRun& run, bool is_random, Answer& answer) const {
    const Study& study = run.study();
    for (std::size_t i = 0; i < failed_.size(); ++i) {
      const auto add = [&](const char* quantity, long failures) {
        Finding f{study.sample.design, study.limit_states[i].name, quantity,
                  static_cast<double>(failures) / static_cast<double>(total_)};
        f.samples = total_;
        if (is_random) {
          const Interval interval =
              proportion_interval(static_cast<double>(failures), static_cast<double>(total_), 0.95);
          f.low = interval.low;
          f.high = interval.high;
        } else {
          f.status = "no interval: the design is not random";
        }
        answer.findings.push_back(f);
      };
      const bool is_both = bad_ > 0 && study.failed == "bounds";
      if (!is_both) add("share of failures", failed_[i] + (study.failed == "unsafe" ? bad_ : 0));
      if (is_both) add("share of failures, runs without result as safe", failed_[i]);
      if (is_both) add("share of failures, runs without result as unsafe", failed_[i] + bad_);
    }
    if (bad_ > 0)
      answer.notes.push_back(std::to_string(bad_) + " of " + std::to_string(total_) +
                             " runs did not reach their end or are not to be trusted: see the reasons");
  }

  const LoadedStudy& loaded_;
  std::vector<Moments> moments_;
  std::vector<long> failed_;
  long total_ = 0, bad_ = 0;
};

} // namespace

void check_sweep(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  double count = 1.0;
  std::size_t longest = 0;
  for (const Variable& v : study.variables) {
    const double levels = !v.values.empty()                          ? static_cast<double>(v.values.size())
                          : v.range.empty() && !v.has_distribution() ? 1.0
                                                                     : static_cast<double>(study.sweep.points);
    count *= levels;
    if (study.sweep.design != "list" || levels == 1.0) continue;
    if (longest && static_cast<double>(longest) != levels)
      problems.push_back(
          {v.where, "variable '" + v.name + "' has " + number_text(levels) + " values, those before it " +
                        std::to_string(longest) +
                        ": a sweep of the design \"list\" takes the first of all, then the second, and so on"});
    longest = static_cast<std::size_t>(levels);
  }
  if (study.variables.empty()) problems.push_back({study.where, "a sweep needs a [[variable]]"});
  if (study.sweep.design == "grid" && count > 1e9)
    problems.push_back({study.sweep.where, "the grid has " + number_text(count) + " points: too many"});
}

namespace {

long points_of(const std::string& design, const std::vector<std::vector<double>>& levels) {
  std::size_t product = 1, sum = 1, longest = 1;
  for (const auto& list : levels) {
    product *= list.size();
    if (list.size() > 1) sum += list.size();
    longest = std::max(longest, list.size());
  }
  return static_cast<long>(design == "grid" ? product : design == "list" ? longest : sum);
}

} // namespace

Answer run_sweep(StudyRun& run) {
  std::vector<std::vector<double>> levels;
  for (std::size_t i = 0; i < run.study().variables.size(); ++i) levels.push_back(levels_of(run, i));
  Sweeper sweeper(run);
  const std::string& design = run.study().sweep.design;
  run.evaluator.expect(points_of(design, levels));
  if (design == "grid") sweep_grid(levels, sweeper);
  else if (design == "list") sweep_list(levels, sweeper);
  else sweep_one_at_a_time(levels, run.law.nominal(), sweeper);
  sweeper.flush();
  Answer answer;
  sweeper.extent().report(run.loaded, answer);
  return answer;
}

void check_random(const LoadedStudy& loaded, bool takes_ranges, std::vector<Diagnostic>& problems) {
  bool is_any = false;
  for (const Variable& v : loaded.study.variables) {
    is_any = is_any || v.has_distribution() || (takes_ranges && !v.range.empty());
    if (!v.values.empty())
      problems.push_back(
          {v.where, "variable '" + v.name + "': a list of values is for sweeps; give a distribution, or 'value'"});
    if (!v.range.empty() && !takes_ranges)
      problems.push_back({v.where, "variable '" + v.name +
                                       "' has a range but no distribution: how likely its values are is not known"});
  }
  if (!is_any)
    problems.push_back({loaded.study.where,
                        "a study of the kind '" + loaded.study.kind + "' needs a [[variable]] with a distribution"});
}

void check_sample(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  check_random(loaded, true, problems);
  constexpr std::size_t k_most = 40; // of a low-discrepancy sequence that still fills space
  if (loaded.study.variables.size() > k_most && loaded.study.sample.design == "halton")
    problems.push_back(
        {loaded.study.sample.where,
         "Halton's sequence does not fill spaces of more than 40 variables: take \"sobol\" or \"latin_hypercube\""});
  if (loaded.study.sample.design == "latin_hypercube" && loaded.study.sample.samples > 100000000)
    problems.push_back(
        {loaded.study.sample.where,
         "a Latin hypercube of so many samples does not fit into memory: take \"sobol\" or \"monte_carlo\""});
}

Answer run_sample(StudyRun& run) {
  const std::size_t dimension = run.law.dimension(), width = run.study().variables.size();
  const auto total = static_cast<std::size_t>(run.study().sample.samples);
  const std::unique_ptr<Design> design = design_of(run.study(), dimension);
  Summary summary(run.loaded);
  run.evaluator.expect(static_cast<long>(total));
  std::vector<double> uniform, u(dimension), points;
  for (std::size_t done = 0; done < total;) {
    const std::size_t count = std::min(k_block, total - done);
    uniform.clear();
    design->next(count, uniform);
    points.resize(count * width);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t d = 0; d < dimension; ++d) u[d] = normal_quantile(uniform[i * dimension + d]);
      run.law.values_at(u.data(), &points[i * width]);
    }
    for (const StoredSample& sample : run.evaluator.evaluate(points)) summary.add(sample);
    done += count;
  }
  run.store.forget_from(run.evaluator.asked() + 1); // of a study that asked for more before it was changed
  Answer answer;
  summary.report(run, answer);
  return answer;
}

} // namespace steplap::study
