#include "tools/study/evidence.h"

#include "mbd/base/shown_text.h"
#include "tools/study/proposal.h"
#include "tools/study/sampling_course.h"
#include "tools/study/weighted_fraction.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace steplap::study {

namespace {

/// Outcome of a statement about one sample. It is unknown for a run without a result.
enum class Truth { no, yes, unknown };

/// One past load ([[evidence]]), with indices instead of names.
struct Load {
  LimitSystem system;
  bool is_held;
  std::vector<std::size_t> anew;              ///< coordinates of standard normal space that are drawn independently for this load
  std::vector<std::pair<int, double>> values; ///< variables with a fixed value in this load: index, value

  [[nodiscard]] Truth agrees(const Outcome& outcome) const {
    const LimitValue value = system.value_of(outcome);
    return value.is_bad ? Truth::unknown : (value.g >= 0.0) == is_held ? Truth::yes : Truth::no;
  }
};

std::size_t coordinate_of(const StudyRun& run, const std::string& variable) {
  const auto& random = run.law.random();
  const auto index = static_cast<std::size_t>(run.study().index_of_variable(variable));
  return static_cast<std::size_t>(std::find(random.begin(), random.end(), index) - random.begin());
}

std::vector<Load> loads_of(const LimitFunction& limit, const StudyRun& run) {
  std::vector<Load> loads;
  for (const Evidence& e : run.study().evidence) {
    const LimitSystem system = e.limit_states.empty() ? limit.system() : LimitSystem(run.loaded, e.limit_states, true);
    Load load{system, e.is_held, {}, e.values};
    for (const std::string& name : e.anew) load.anew.push_back(coordinate_of(run, name));
    loads.insert(loads.end(), static_cast<std::size_t>(e.times), load);
  }
  return loads;
}

/// Weighted mean and standard deviation of a variable in samples that agree with the evidence.
struct Moments {
  double weights = 0.0, sum = 0.0, squares = 0.0;
  void add(double w, double x) {
    weights += w;
    sum += w * x;
    squares += w * x * x;
  }
  [[nodiscard]] double mean() const { return sum / weights; }
  [[nodiscard]] double deviation() const { return std::sqrt(std::max(0.0, squares / weights - mean() * mean())); }
};

class EvidenceSampling {
public:
  EvidenceSampling(LimitFunction& limit, const DesignPoints& points, const SamplingTarget& target)
      : limit_(limit), run_(limit.run()), target_(target), course_(limit, target),
        random_(static_cast<std::uint64_t>(run_.study().seed), k_stream), loads_(loads_of(limit, run_)), moments_(limit.dimension()) {
    if (!points.points.empty()) proposal_.emplace(points.points, std::vector<std::vector<double>>{}, limit.dimension());
    e_.method = "evidence";
  }

  void add_to(Answer& answer) {
    // The end criterion is checked only each time the number of samples has doubled. Frequent checks would bias the estimate.
    constexpr long k_first = 500;
    for (long count = k_first; !course_.is_over() && !is_enough(); count *= 2) draw_until(count);
    course_.say_why_it_ended(e_);
    judge();
    add_findings(e_, limit_, run_.study().failed, answer);
    add_circumstances(answer);
    add_variables(answer);
    add_samples(answer);
    answer.notes.push_back(sentence());
    if (e_.bad > 0)
      answer.notes.push_back(counted(static_cast<std::size_t>(e_.bad), "sample counts", "samples count") + " as \"" + run_.study().failed +
                             "\": a run did not reach its end or is not to be trusted");
  }

private:
  [[nodiscard]] std::size_t rows_per_sample() const { return 1 + loads_.size(); }

  void draw_until(long count) {
    while (drawn_ < count && !course_.is_over()) {
      const long room = std::max(1L, course_.left() / static_cast<long>(rows_per_sample()));
      const long block = std::max<long>(1, static_cast<long>(course_.block() / rows_per_sample()));
      draw(std::min({count - drawn_, block, room}));
      set();
      course_.note(e_);
    }
  }

  void draw(long count) {
    values_.clear();
    weights_.clear();
    for (long i = 0; i < count; ++i) append_sample(static_cast<std::uint64_t>(drawn_ + i));
    const std::vector<StoredSample>& rows = run_.evaluator.evaluate(values_);
    for (long i = 0; i < count; ++i) {
      const std::size_t first = static_cast<std::size_t>(i) * rows_per_sample();
      const LimitValue value = limit_.system().value_of(rows[first].outcome);
      const Truth fails = value.is_bad ? Truth::unknown : value.g < 0.0 ? Truth::yes : Truth::no;
      add(static_cast<std::uint64_t>(drawn_ + i), weights_[static_cast<std::size_t>(i)], fails, agreement(&rows[first + 1]),
          rows[first].values);
    }
    drawn_ += count;
  }

  static bool is_plain(std::uint64_t sample) { return sample % 2 == 0; }

  // Appends the values of all variables for the coming load, then for each past load.
  void append_sample(std::uint64_t sample) {
    const std::size_t n = limit_.dimension();
    std::vector<double> u;
    if (is_plain(sample) || !proposal_)
      for (std::size_t d = 0; d < n; ++d) u.push_back(random_.normal(sample, static_cast<std::uint32_t>(d + 2)));
    else (void)proposal_->draw(random_, sample, u);
    weights_.push_back(proposal_ ? 1.0 / (1.0 + 1.0 / proposal_->weight(u.data())) : 1.0);
    append_values(u);
    std::size_t index = n + 2;
    for (const Load& load : loads_) {
      std::vector<double> v = u;
      for (const std::size_t d : load.anew) v[d] = random_.normal(sample, static_cast<std::uint32_t>(index++));
      double* const values = append_values(v);
      for (const auto& [variable, value] : load.values) values[variable] = value;
    }
  }

  double* append_values(const std::vector<double>& u) {
    const std::size_t width = run_.study().variables.size();
    values_.resize(values_.size() + width);
    double* const values = &values_[values_.size() - width];
    run_.law.values_at(u.data(), values);
    return values;
  }

  Truth agreement(const StoredSample* rows) const {
    Truth all = Truth::yes;
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      const Truth one = loads_[k].agrees(rows[k].outcome);
      if (one == Truth::no) return Truth::no;
      if (one == Truth::unknown) all = Truth::unknown;
    }
    return all;
  }

  // Adds a sample. If failure or agreement with the evidence is unknown, it increases the upper bound of the probability and decreases the
  // lower bound.
  void add(std::uint64_t sample, double w, Truth fails, Truth agrees, const std::vector<double>& values) {
    e_.bad += fails == Truth::unknown || agrees == Truth::unknown;
    prior_.add(w, fails == Truth::yes);
    evidence_.add(w, agrees == Truth::yes);
    const bool is_safe = fails != Truth::yes, is_unsafe = fails != Truth::no;
    if (agrees == Truth::yes || (agrees == Truth::unknown && is_safe)) safe_.add(w, !is_safe);
    if (agrees == Truth::yes || (agrees == Truth::unknown && is_unsafe)) unsafe_.add(w, is_unsafe);
    if (agrees != Truth::yes) return;
    for (std::size_t d = 0; d < moments_.size(); ++d) moments_[d].add(w, values[run_.law.random()[d]]);
    constexpr std::size_t k_most = 1000; // sufficient to fit a distribution
    if (is_plain(sample) && kept_.size() < k_most) kept_.push_back(values);
  }

  void set() {
    const auto share = [&](const WeightedFraction& f) {
      return Share{f.mean(), f.deviation(), f.interval(target_.confidence), f.interval(target_.test_confidence)};
    };
    course_.set(e_, share(safe_), share(unsafe_));
  }

  [[nodiscard]] bool is_enough() const {
    return e_.cov <= target_.cov && safe_.effective() >= k_fewest && unsafe_.effective_hits() >= k_fewest_failures;
  }

  void judge() {
    const double agreeing = safe_.effective(), failing = unsafe_.effective_hits();
    if (agreeing >= k_fewest && failing >= k_fewest_failures) return;
    const double left = agreeing < k_fewest ? agreeing : failing;
    e_.status += std::string(e_.status.empty() ? "" : "; ") + "only " + rounded_text(left, 3) + " effective samples " +
                 (agreeing < k_fewest ? "agree with the evidence" : "of failure agree with the evidence") + ": too few to judge by";
    e_.is_trusted = false;
  }

  void put(Answer& answer, const std::string& subject, const std::string& quantity, double value, Interval interval = {k_nan, k_nan}) {
    answer.findings.push_back({e_.method, subject, quantity, value, interval.low, interval.high, e_.samples});
  }

  void add_circumstances(Answer& answer) {
    put(answer, limit_.subject(), "without evidence", prior_.mean(), prior_.interval(target_.confidence));
    put(answer, limit_.subject(), "chance of the evidence", evidence_.mean(), evidence_.interval(target_.confidence));
    put(answer, limit_.subject(), "effective samples", safe_.effective());
  }

  // Returns the coordinates about which the evidence gives information: those that keep their values in at least one past load.
  [[nodiscard]] std::vector<std::size_t> lasting_coordinates() const {
    std::vector<std::size_t> lasting;
    for (std::size_t d = 0; d < limit_.dimension(); ++d) {
      const auto is_told = [&](const Load& load) {
        const auto variable = static_cast<int>(run_.law.random()[d]);
        return std::find(load.anew.begin(), load.anew.end(), d) == load.anew.end() &&
               std::none_of(load.values.begin(), load.values.end(), [&](const auto& set) { return set.first == variable; });
      };
      if (std::any_of(loads_.begin(), loads_.end(), is_told)) lasting.push_back(d);
    }
    return lasting;
  }

  void add_variables(Answer& answer) {
    for (const std::size_t d : lasting_coordinates()) {
      const std::string& name = run_.study().variables[run_.law.random()[d]].name;
      put(answer, name, "mean with evidence", moments_[d].mean());
      put(answer, name, "standard deviation with evidence", moments_[d].deviation());
    }
  }

  // Adds the samples that agree with the evidence as findings. Only samples drawn from the distributions themselves are used, so all have
  // equal weight.
  void add_samples(Answer& answer) {
    const std::vector<std::size_t> lasting = lasting_coordinates();
    for (std::size_t k = 0; k < kept_.size(); ++k)
      for (const std::size_t d : lasting) {
        const std::size_t variable = run_.law.random()[d];
        put(answer, "posterior sample " + std::to_string(k + 1), run_.study().variables[variable].name, kept_[k][variable]);
      }
  }

  [[nodiscard]] std::string sentence() const {
    const std::string& failed = run_.study().failed;
    const Interval interval = e_.interval(failed);
    const auto text = [](double p) { return rounded_text(p, 4); };
    return "With the evidence of " + counted(loads_.size(), "past load", "past loads") + " the probability of failure is " +
           text(failed == "unsafe" ? e_.unsafe : e_.safe) + " (with " + rounded_text(100.0 * target_.confidence, 4) + " % confidence " +
           text(interval.low) + " to " + text(interval.high) + "). Without it is " + text(prior_.mean()) + ".";
  }

  // Below this effective number of samples the intervals of ratios are not reliable: the denominator scatters by a tenth.
  static constexpr double k_fewest = 100.0;
  static constexpr std::uint32_t k_stream = 12;
  static constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

  LimitFunction& limit_;
  StudyRun& run_;
  const SamplingTarget& target_;
  SamplingCourse course_;
  CounterRandom random_;
  std::optional<Proposal> proposal_; ///< empty if no design point was found
  std::vector<Load> loads_;
  Estimate e_;
  WeightedFraction prior_, evidence_, safe_, unsafe_;
  std::vector<Moments> moments_; ///< one entry per random variable
  std::vector<std::vector<double>> kept_;
  std::vector<double> values_, weights_;
  long drawn_ = 0;
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_set(const Evidence& e, int variable) {
  return std::any_of(e.values.begin(), e.values.end(), [&](const auto& set) { return set.first == variable; });
}

std::vector<std::string> names_of(const Study& study) {
  std::vector<std::string> names;
  for (const Variable& v : study.variables) names.push_back(v.name);
  return names;
}

// Reports an error for correlated variables of which one is drawn independently or fixed in past loads and the other is not: the
// correlation could not hold there.
void check_correlations(const Study& study, const Evidence& e, std::vector<Diagnostic>& problems) {
  const auto group = [&](const std::string& name) { return contains(e.anew, name) ? 1 : is_set(e, study.index_of_variable(name)) ? 2 : 0; };
  for (const Correlation& c : study.correlations)
    if (group(c.between[0]) != group(c.between[1]) || group(c.between[0]) == 2)
      problems.push_back({e.where, "'" + c.between[0] + "' and '" + c.between[1] +
                                       "' are correlated: draw both anew in past loads, or leave both as they are"});
}

void check_names(const Study& study, const Evidence& e, std::vector<Diagnostic>& problems) {
  for (const std::string& name : e.anew) {
    const int v = study.index_of_variable(name);
    if (v < 0) problems.push_back({e.where, "there is no variable '" + name + "'" + did_you_mean(name, names_of(study))});
    else if (!study.variables[static_cast<std::size_t>(v)].has_distribution())
      problems.push_back({e.where, "variable '" + name + "' has no distribution to be drawn anew from"});
    else if (is_set(e, v)) problems.push_back({e.where, "variable '" + name + "' is either drawn anew or set"});
  }
  std::vector<std::string> limits;
  for (const LimitState& l : study.limit_states) limits.push_back(l.name);
  for (const std::string& name : e.limit_states)
    if (!contains(limits, name)) problems.push_back({e.where, "there is no limit state '" + name + "'" + did_you_mean(name, limits)});
}

void check_loads(const Study& study, const Evidence& e, std::vector<Diagnostic>& problems) {
  bool is_any_lasting = false, is_any_other = !e.limit_states.empty();
  for (std::size_t i = 0; i < study.variables.size(); ++i) {
    const Variable& v = study.variables[i];
    const bool is_other = contains(e.anew, v.name) || is_set(e, static_cast<int>(i));
    is_any_other = is_any_other || is_other;
    is_any_lasting = is_any_lasting || (v.has_distribution() && !is_other);
  }
  if (!is_any_lasting)
    problems.push_back({e.where, "all random variables are drawn anew or set: such a load says nothing about the next one"});
  if (!is_any_other)
    problems.push_back(
        {e.where, "no variable is drawn anew or set: the load would be the next one itself. Say what differed: 'anew' or 'set'"});
  if (e.times > 1 && e.anew.empty())
    problems.push_back({e.where, "'times' is for loads that differ: without 'anew' a load says once what it says"});
}

} // namespace

void check_evidence(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  if (study.evidence.empty()) return;
  const auto& s = settings_of<ReliabilitySettings>(study);
  if (s.methods != ReliabilitySettings{}.methods)
    problems.push_back({s.where, "a study with [[evidence]] has its own method: leave 'methods' out"});
  for (const Evidence& e : study.evidence) {
    check_names(study, e, problems);
    check_loads(study, e, problems);
    check_correlations(study, e, problems);
  }
  if (s.limit_states.empty() && std::all_of(study.limit_states.begin(), study.limit_states.end(), [&](const LimitState& l) {
        return std::any_of(study.evidence.begin(), study.evidence.end(),
                           [&](const Evidence& e) { return contains(e.limit_states, l.name); });
      }))
    problems.push_back({s.where, "all limit states are of evidence: name those of the next load with 'limit_states'"});
}

void sample_with_evidence(LimitFunction& limit, const DesignPoints& points, const SamplingTarget& target, Answer& answer) {
  EvidenceSampling(limit, points, target).add_to(answer);
}

} // namespace steplap::study
