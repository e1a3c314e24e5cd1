// Study kind "sample": draws samples from the distributions and describes the responses.
#include "tools/study/kinds.h"

#include "tools/study/counter_random.h"
#include "tools/study/random_variables.h"

#include <openturns/HaltonSequence.hxx>
#include <openturns/SobolSequence.hxx>

#include <cmath>
#include <memory>
#include <numeric>

namespace steplap::study {

namespace {

/// Settings of a "sample" study.
struct SampleSettings : KindSettings {
  std::string design = "monte_carlo"; ///< monte_carlo, latin_hypercube, sobol, halton
  long samples = 1000;
};

FieldTable sample_fields() {
  FieldTable t;
  t.add("design", &SampleSettings::design).one_of({"monte_carlo", "latin_hypercube", "sobol", "halton"}).doc("how samples are drawn");
  t.add("samples", &SampleSettings::samples).at_least(1).at_most(1e9).doc("their number");
  return t;
}

constexpr std::size_t k_block = 10000; // largest number of samples per request, which limits the memory

/// A method that chooses points of the unit cube.
class Design {
public:
  virtual ~Design() = default;
  virtual void next(std::size_t count, std::vector<double>& uniform) = 0; ///< returns the next `count` points, one after the other
};

class MonteCarlo : public Design {
public:
  MonteCarlo(std::uint64_t seed, std::size_t dimension) : random_(seed, 1), dimension_(dimension) {}
  void next(std::size_t count, std::vector<double>& uniform) override {
    for (std::size_t i = 0; i < count; ++i, ++sample_)
      for (std::size_t d = 0; d < dimension_; ++d) uniform.push_back(random_.uniform(sample_, static_cast<std::uint32_t>(d)));
  }

private:
  CounterRandom random_;
  std::size_t dimension_;
  std::uint64_t sample_ = 0;
};

/// Latin hypercube: each variable's range is divided into as many strata as there are samples, with one sample in each. Strata of different
/// variables are paired at random.
class LatinHypercube : public Design {
public:
  LatinHypercube(std::uint64_t seed, std::size_t dimension, std::size_t count) : random_(seed, 2), count_(count), strata_(dimension) {
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
  const auto& s = settings_of<SampleSettings>(study);
  const std::string& name = s.design;
  const auto seed = static_cast<std::uint64_t>(study.seed);
  if (name == "latin_hypercube") return std::make_unique<LatinHypercube>(seed, dimension, static_cast<std::size_t>(s.samples));
  if (name == "sobol") return std::make_unique<LowDiscrepancy<OT::SobolSequence>>(dimension);
  if (name == "halton") return std::make_unique<LowDiscrepancy<OT::HaltonSequence>>(dimension);
  return std::make_unique<MonteCarlo>(seed, dimension);
}

// Mean and variance of finite values, updated sample by sample (Welford).
struct Moments {
  long count = 0, missing = 0, unknown = 0; ///< missing: not finite, for example the time of an event that never happened; unknown: NaN
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
  [[nodiscard]] double deviation() const { return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : std::nan(""); }
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
    const std::string& method = settings_of<SampleSettings>(run.study()).design;
    const bool is_random = method == "monte_carlo";
    const std::vector<std::string> names = loaded_.number_names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Moments& m = moments_[i];
      const std::string status =
          m.missing ? std::to_string(m.missing) + " of " + std::to_string(total_) + " runs gave no finite value and are left out" : "";
      Finding mean{method, names[i], "mean", m.count ? m.mean : std::nan("")};
      mean.samples = m.count;
      mean.status = status;
      if (is_random && m.count > 1) {
        const double half =
            student_quantile(static_cast<double>(m.count - 1), 0.975) * m.deviation() / std::sqrt(static_cast<double>(m.count));
        mean.low = m.mean - half;
        mean.high = m.mean + half;
      }
      answer.findings.push_back(mean);
      Finding deviation{method, names[i], "standard deviation", m.deviation()};
      deviation.samples = m.count;
      deviation.status = status;
      answer.findings.push_back(deviation);
      for (const double p : {0.05, 0.5, 0.95}) answer.findings.push_back(quantile(run, i, p, is_random));
      // Runs without a value may differ systematically from the others, so results of the rest may be biased.
      if (m.unknown > 0) answer.degrade(m.unknown == total_ ? Standing::not_trusted : Standing::not_met);
    }
    if (bad_ > 0) answer.degrade(Standing::not_met);
    report_failures(run, is_random, answer);
  }

private:
  // Returns the p-quantile of the values in the store, with a confidence interval from order statistics.
  Finding quantile(StudyRun& run, std::size_t i, double p, bool is_random) const {
    char text[40];
    std::snprintf(text, sizeof text, "%g %% quantile", 100.0 * p);
    Finding f{settings_of<SampleSettings>(run.study()).design, loaded_.number_names()[i], text};
    const long n = run.evaluator.store().count_of(i);
    f.samples = n;
    if (n < total_) f.status = std::to_string(total_ - n) + " of " + std::to_string(total_) + " runs gave no value and are left out";
    if (n == 0) return f;
    const auto place = [n](double share) { return std::clamp(static_cast<long>(std::floor(share * static_cast<double>(n))), 0L, n - 1); };
    f.value = run.evaluator.store().order_statistic(i, place(p));
    if (!is_random) return f;
    const double half = 1.96 * std::sqrt(p * (1.0 - p) / static_cast<double>(n));
    if (p - half > 0.0) f.low = run.evaluator.store().order_statistic(i, place(p - half));
    if (p + half < 1.0) f.high = run.evaluator.store().order_statistic(i, place(p + half));
    return f;
  }

  void report_failures(StudyRun& run, bool is_random, Answer& answer) const {
    const Study& study = run.study();
    for (std::size_t i = 0; i < failed_.size(); ++i) {
      const auto add = [&](const char* quantity, long failures) {
        Finding f{settings_of<SampleSettings>(study).design, study.limit_states[i].name, quantity,
                  static_cast<double>(failures) / static_cast<double>(total_)};
        f.samples = total_;
        if (is_random) {
          const Interval interval = proportion_interval(static_cast<double>(failures), static_cast<double>(total_), 0.95);
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

void check_sample(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  check_random(loaded, true, problems);
  const auto& s = settings_of<SampleSettings>(loaded.study);
  constexpr std::size_t k_most = 40; // largest dimension for a low-discrepancy sequence
  if (loaded.study.variables.size() > k_most && s.design == "halton")
    problems.push_back(
        {s.where, "Halton's sequence does not fill spaces of more than 40 variables: take \"sobol\" or \"latin_hypercube\""});
  if (s.design == "latin_hypercube" && s.samples > 100000000)
    problems.push_back({s.where, "a Latin hypercube of so many samples does not fit into memory: take \"sobol\" or \"monte_carlo\""});
}

Answer run_sample(StudyRun& run) {
  const std::size_t dimension = run.law.dimension(), width = run.study().variables.size();
  const auto total = static_cast<std::size_t>(settings_of<SampleSettings>(run.study()).samples);
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
  run.evaluator.store().forget_from(run.evaluator.asked() + 1); // removes samples that an earlier version of the study requested
  Answer answer;
  summary.report(run, answer);
  return answer;
}

Drawn sample_drawn(const ShownSettings& settings) {
  return is_only(settings, "design", "monte_carlo") ? Drawn::independently : Drawn::by_design;
}

} // namespace

StudyKind sample_kind() {
  StudyKind kind;
  kind.name = "sample";
  kind.doc = "samples drawn from the distributions: what the responses are like";
  kind.fields = sample_fields();
  kind.holds<SampleSettings>();
  kind.shown = {"design"};
  kind.draws_jointly = true;
  kind.shows_running_means = true;
  kind.parts = {{"probability", "share of failures", UnitOf::none, 4},
                {"moment", "mean", UnitOf::subject, 4},
                {"moment", "standard deviation", UnitOf::subject, 4},
                {"quantile", " quantile", UnitOf::subject, 4}};
  kind.check = check_sample;
  kind.run = run_sample;
  kind.drawn = sample_drawn;
  return kind;
}

} // namespace steplap::study
