#include "tools/study/design.h"

#include "mbd/base/shown_text.h"
#include "mbd/model/model_path.h"
#include "mbd/run/quantity_text.h"
#include "tools/study/case_limits.h"
#include "tools/study/design_choice.h"
#include "tools/study/holding.h"
#include "tools/study/kinds.h"
#include "tools/study/target_border.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

namespace steplap::study {

namespace {

FieldTable design_fields() {
  using S = DesignSettings;
  FieldTable t;
  t.add("beta", &S::beta).not_negative().at_most(8).doc("target: the reliability index that is wanted at least");
  t.add("p", &S::p)
      .positive()
      .at_most(0.5)
      .doc("target: the probability of failure that is allowed at most; neither: all limits hold for certain");
  t.add("points", &S::points).at_least(3).at_most(1e6).doc("of the first look along the range: narrower intervals are not seen");
  t.add("tolerance", &S::tolerance).positive().at_most(0.01).doc("of a border, of its value");
  t.add("cost", &S::cost).doc("formula of the variables: of all combinations of their values the cheapest that holds is sought");
  t.add<S, double>("cov", &S::cov).positive().at_most(1).doc("sampling stops at this coefficient of variation of the probability");
  t.add<S, long>("samples", &S::samples).at_least(1).at_most(1e10).doc("and at this number of samples, at each value that is sampled");
  t.add<S, long>("starts", &S::starts).at_least(1).at_most(1000).doc("of the search for design points at each value");
  t.add<S, std::optional<long>>("search_samples", &S::search_samples)
      .at_least(10)
      .at_most(1e7)
      .doc("for the searches at each value; 300 and 50 more for each variable if not given");
  t.add<S, double>("confidence", &S::confidence).at_least(0.5).at_most(0.9999).doc("of all intervals");
  return t;
}

bool is_sought(const Variable& v) { return !v.range.empty() || !v.values.empty(); }

// Returns the index of the design variable, or the number of variables if there is none.
std::size_t sought_variable(const Study& study) {
  const auto found = std::find_if(study.variables.begin(), study.variables.end(), is_sought);
  return static_cast<std::size_t>(found - study.variables.begin());
}

std::optional<double> target_of(const DesignSettings& s) {
  if (s.beta) return s.beta;
  return s.p ? std::optional(-normal_quantile(*s.p)) : std::nullopt;
}

// --- before the study

bool is_whole_number(const Variable& v, const LoadedStudy& loaded) {
  if (v.paths.empty() || v.is_factor) return false;
  return std::any_of(loaded.models.begin(), loaded.models.end(), [&](const auto& model) {
    return is_set_in(v, *model) && std::holds_alternative<long>(value_of(model->given, v.paths.front()));
  });
}

// Prepares the design variable. A whole number gets the list of all whole numbers in its range. The mean of a random variable starts in the
// middle of its range.
void prepare_sought(Variable& v, const LoadedStudy& loaded) {
  constexpr double k_most = 10000; // longer ranges of whole numbers are searched like real numbers
  if (v.range.size() == 2 && is_whole_number(v, loaded) && v.range[1] - v.range[0] < k_most) {
    for (double x = std::ceil(v.range[0]); x <= v.range[1]; x += 1.0) v.values.push_back(x);
    v.range.clear();
  }
  if (v.has_distribution()) v.mean = v.range.empty() ? v.values.front() : 0.5 * (v.range[0] + v.range[1]);
}

void prepare_design(LoadedStudy& loaded) {
  Study& study = loaded.study;
  for (Variable& v : study.variables)
    if (is_sought(v)) prepare_sought(v, loaded);
  if (study.limit_states.empty() && study.responses.empty()) add_limits_of_cases(loaded);
}

bool names(const std::string& expression, const std::string& variable) {
  return std::regex_search(expression, std::regex("\\b" + variable + "\\b"));
}

// Returns true if a model or an expression uses the variable.
bool is_used(const Variable& v, const LoadedStudy& loaded) {
  const Study& study = loaded.study;
  constexpr std::string_view k_parameters = "parameters.";
  for (const auto& model : loaded.models)
    for (const std::string& path : v.paths) {
      if (!is_set_in(v, *model)) continue;
      if (!path.starts_with(k_parameters)) return true;
      const Parameters& parameters = model->given.parameters;
      const std::optional<std::size_t> index = parameters.find(path.substr(k_parameters.size()));
      if (index && std::any_of(parameters.uses.begin(), parameters.uses.end(),
                               [&](const ParameterUse& use) { return parameters.needs(use.formula, *index); }))
        return true;
    }
  return std::any_of(study.responses.begin(), study.responses.end(), [&](const Response& r) { return names(r.expression, v.name); }) ||
         std::any_of(study.limit_states.begin(), study.limit_states.end(),
                     [&](const LimitState& l) { return names(l.expression, v.name); });
}

void check_use(const Variable& v, const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  if (is_used(v, loaded)) return;
  problems.push_back(
      {v.where, "no limit depends on variable '" + v.name + "': give it a path that a model uses, or name it in a limit state"});
}

void check_variables(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  const std::size_t sought = sought_variable(study);
  if (sought == study.variables.size()) {
    problems.push_back({study.where, "a design study needs the [[variable]] whose value is sought, with a 'range' or with 'values'"});
    return;
  }
  const Variable& v = study.variables[sought];
  for (std::size_t i = sought; i < study.variables.size(); ++i) {
    const Variable& other = study.variables[i];
    if (!is_sought(other)) continue;
    check_use(other, loaded, problems);
    if (i > sought && !is_choice(study))
      problems.push_back(
          {other.where, "variables '" + v.name + "' and '" + other.name +
                            "' both have a range or values: a design study seeks the value of one variable. Among 'values' of "
                            "several it chooses by 'cost'"});
  }
}

// Checks that the distributions are valid at all values that the design variable may have.
void check_laws(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const std::size_t sought = sought_variable(loaded.study);
  const Variable& v = loaded.study.variables[sought];
  for (const double x : v.range.empty() ? v.values : v.range) {
    const LoadedStudy changed = with_design_value(loaded, sought, x);
    std::vector<Diagnostic> found;
    (void)JointLaw(changed.study, changed.nominal, found);
    problems.insert(problems.end(), found.begin(), found.end());
    if (!found.empty()) return;
  }
}

void check_target(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const auto& s = settings_of<DesignSettings>(loaded.study);
  const auto random =
      std::find_if(loaded.study.variables.begin(), loaded.study.variables.end(), [](const Variable& v) { return v.has_distribution(); });
  const bool is_random = random != loaded.study.variables.end();
  if (s.beta && s.p) problems.push_back({s.where, "'beta' and 'p' are the same target: give one of them"});
  if (target_of(s) && !is_random)
    problems.push_back(
        {s.where, "a target probability needs a [[variable]] with a distribution; without target all limits hold for certain"});
  if (!target_of(s) && is_random)
    problems.push_back({random->where, "variable '" + random->name + "' has a distribution: give the target, 'beta' or 'p' of [design]"});
}

void check_design(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  if (study.limit_states.empty() && !study.responses.empty())
    problems.push_back(
        {study.responses.front().where, "responses need a [[limit_state]]; without both, the limits of the model and its cases are used"});
  else if (study.limit_states.empty()) problems.push_back({study.where, "a design study needs a model with limits, or a [[limit_state]]"});
  if (study.failed == "safe")
    problems.push_back({study.where, "failed = \"safe\" does not go with a design: what has no trusted result counts as not holding"});
  const std::size_t before = problems.size();
  check_variables(loaded, problems);
  if (is_choice(study)) return check_choice(loaded, problems);
  check_target(loaded, problems);
  if (problems.size() == before) check_laws(loaded, problems);
}

// --- the study

/// Result at one value of the design variable.
struct DesignValue {
  double margin = 0.0; ///< least limit state, or reliability index minus its target; negative: the limits do not hold
  std::string doubt;   ///< reason if the margin is unknown, which is treated as not holding; "" otherwise
  std::string zero{};  ///< sentence if the margin is zero to rounding, which is treated as not holding; "" otherwise
};

std::string text_of(const char* format, double a, double b = 0.0) {
  char text[120];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

class Design {
public:
  explicit Design(StudyRun& run)
      : run_(run), settings_(settings_of<DesignSettings>(run.study())), sought_(sought_variable(run.study())),
        variable_(run.study().variables[sought_]), target_(target_of(settings_)),
        search_(run, sought_, target_.value_or(0.0), sampling_of(settings_)) {}

  Answer answer() {
    const LineFunction function = [this](const std::vector<double>& xs) { return margins_at(xs); };
    LineSamples samples;
    if (is_list()) {
      add_samples(function, variable_.values, samples);
    } else {
      add_samples(function, evenly_spaced(variable_.range[0], variable_.range[1], settings_.points), samples);
      refine_turns(function, samples);
    }
    std::vector<HoldingInterval> intervals =
        holding_intervals(samples, is_list() ? std::vector<Crossing>{} : closed_crossings(function, samples, settings_.tolerance));
    doubt_stretches_of_zeros(samples);
    if (target_ && !is_list()) correct_by_sampling(intervals);
    answer_.notes.insert(answer_.notes.begin(), sentence(intervals));
    if (intervals.empty()) answer_.degrade(Standing::not_met);
    add_findings(intervals);
    add_notes(samples);
    return std::move(answer_);
  }

private:
  // A margin that is zero to rounding at a single value is a border. If it is zero at two neighbouring values, the number is stuck at its
  // limit, and both values are unknown.
  void doubt_stretches_of_zeros(const LineSamples& samples) {
    for (std::size_t i = 1; i < samples.x.size(); ++i) {
      DesignValue &before = known_.at(samples.x[i - 1]), &here = known_.at(samples.x[i]);
      if (before.zero.empty() || here.zero.empty()) continue;
      before.doubt = before.zero;
      here.doubt = here.zero;
    }
  }

  static SamplingTarget sampling_of(const DesignSettings& s) {
    SamplingTarget sampling;
    sampling.cov = s.cov;
    sampling.samples = s.samples;
    sampling.confidence = s.confidence;
    return sampling;
  }

  [[nodiscard]] bool is_list() const { return !variable_.values.empty(); }

  // Returns a margin that is never zero: at least 1e-12 in magnitude, positive if the value holds and negative otherwise.
  static double signed_margin(const DesignValue& value) {
    constexpr double k_least = 1e-12;
    if (!value.doubt.empty()) return std::min(std::isnan(value.margin) ? -1.0 : value.margin, -k_least);
    if (!value.zero.empty()) return -k_least;
    return value.margin < 0.0 ? std::min(value.margin, -k_least) : std::max(value.margin, k_least);
  }

  std::vector<double> margins_at(const std::vector<double>& xs) {
    if (target_)
      for (const double x : xs) known_[x] = index_at(x);
    else run_at(xs);
    // Replaces an unknown margin by −1, so that the search for zeros does not converge to it.
    constexpr double k_unknown = -1.0, k_least = 1e-6;
    std::vector<double> margins;
    for (const double x : xs) {
      const double margin = signed_margin(known_.at(x));
      margins.push_back(!known_.at(x).doubt.empty() && margin > -k_least ? k_unknown : margin);
    }
    return margins;
  }

  [[nodiscard]] std::vector<double> values_at(double x) const {
    std::vector<double> values = run_.law.nominal();
    values[sought_] = x;
    return values;
  }

  // Runs one sample per value and stores its least limit state. Used without a target reliability.
  void run_at(const std::vector<double>& xs) {
    std::vector<double> points;
    for (const double x : xs) {
      const std::vector<double> values = values_at(x);
      points.insert(points.end(), values.begin(), values.end());
    }
    const std::size_t first = run_.study().responses.size();
    const std::vector<StoredSample>& rows = run_.evaluator.evaluate(points);
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const Outcome& outcome = rows[i].outcome;
      const auto least = std::min_element(outcome.numbers.begin() + static_cast<long>(first), outcome.numbers.end());
      const bool is_undecided = outcome.status == SampleStatus::undecided, is_known = is_undecided || outcome.status == SampleStatus::ok;
      known_[xs[i]] = {*least, is_known ? "" : outcome.reason, is_undecided && *least == 0.0 ? outcome.reason : ""};
      governing_[xs[i]] = static_cast<std::size_t>(least - outcome.numbers.begin()) - first;
    }
  }

  // Returns the reliability index minus the target at x. For a range the index is that of first order, or from sampling if no design point
  // is found. For a list of values, whose borders are not refined, it is the lower end of the confidence interval from sampling.
  DesignValue index_at(double x) {
    if (!is_list()) {
      IndexEstimate index = search_.first_order(x);
      if (!index.doubt.empty()) index = search_.sampled(x);
      return {index.beta - *target_, index.doubt};
    }
    const IndexEstimate index = search_.sampled(x);
    std::string doubt = index.doubt;
    if (doubt.empty() && index.low < *target_ && index.high >= *target_)
      doubt = text_of("the target is in the interval of the index, %.4g to %.4g: more samples decide", index.low, index.high);
    return {index.low - *target_, doubt};
  }

  void correct_by_sampling(std::vector<HoldingInterval>& intervals) {
    for (HoldingInterval& interval : intervals)
      for (HoldingEnd* end : {&interval.from, &interval.to}) {
        if (end->is_range_end) continue;
        if (const std::string& doubt = known_.at(end->beyond).doubt; !doubt.empty())
          continue; // the margin beyond this end is unknown, so the end is not where the index reaches the target
        report("form", "border of first order", end->value);
        const TargetBorder border = search_.border_near(end->value, variable_.range[0], variable_.range[1]);
        report("importance_sampling", "checked at", border.checked_at);
        const Interval p = border.check.interval("bounds");
        answer_.findings.push_back({"importance_sampling", variable_.name, "probability", border.check.unsafe, p.low, p.high,
                                    border.check.samples, border.doubt.empty() ? border.check.status : border.doubt});
        if (!border.doubt.empty()) answer_.degrade(Standing::not_trusted);
        else if (!border.check.is_target_met) answer_.degrade(Standing::not_met);
        end->value = border.value;
        end->low = border.low;
        end->high = border.high;
      }
  }

  void report(const char* method, const char* quantity, double value) {
    answer_.findings.push_back({method, variable_.name, quantity, value, std::nan(""), std::nan(""), run_.evaluator.asked()});
  }

  // --- the answer

  [[nodiscard]] std::string subject() const { return (variable_.has_distribution() ? "the mean of '" : "'") + variable_.name + "'"; }
  [[nodiscard]] std::string quantity(double x) const { return rounded_quantity(x, variable_.unit, false, digits()); }
  [[nodiscard]] int digits() const { // one digit more than the tolerance of the border determines
    return target_ && !is_list() ? 4 : std::clamp(2 - static_cast<int>(std::floor(std::log10(settings_.tolerance))), 4, 12);
  }

  std::string sentence(const std::vector<HoldingInterval>& intervals) {
    std::string claim = "All limits hold";
    if (target_) claim = text_of("The probability of failure is at most %.4g (beta at least %.4g)", normal_cdf(-*target_), *target_);
    if (!intervals.empty())
      return claim + " if " + subject() + " is " +
             intervals_text(intervals, variable_.unit, digits(), target_ ? std::optional(settings_.confidence) : std::nullopt) + ".";
    const auto best = std::max_element(known_.begin(), known_.end(),
                                       [](const auto& a, const auto& b) { return signed_margin(a.second) < signed_margin(b.second); });
    return claim + " with no value of " + subject() + " that was tried, " + quantity(known_.begin()->first) + " to " +
           quantity(known_.rbegin()->first) + ". Nearest is " + quantity(best->first) + ": " + reason_at(best->first);
  }

  // Returns one sentence that says why the limits do not hold at x.
  std::string reason_at(double x) {
    const DesignValue& value = known_.at(x);
    if (!value.doubt.empty()) return value.doubt;
    if (!value.zero.empty()) return value.zero;
    if (target_) return text_of("the reliability index is %.4g there.", value.margin + *target_);
    const std::size_t limit = governing_.at(x);
    const std::string& name = run_.study().limit_states[limit].name;
    const StudyModel* model = model_of_limit(run_.loaded, limit);
    if (!model) return "limit state '" + name + "' is negative.";
    const std::string reason = reason_of_verdict(run_.loaded, *model, values_at(x).data());
    return model->load ? "in case '" + model->name + "' " + reason : reason;
  }

  void add_end(const char* which, const HoldingEnd& end) {
    Finding f{"design", variable_.name, which, end.value, end.low, end.high, run_.evaluator.asked()};
    const bool is_corrected = target_ && !is_list() && !end.is_range_end && known_.at(end.beyond).doubt.empty();
    if (end.is_range_end) f.status = "the end of the range";
    else if (!is_corrected) f.status = "at " + quantity(end.beyond) + ": " + reason_at(end.beyond);
    answer_.findings.push_back(std::move(f));
  }

  void add_findings(const std::vector<HoldingInterval>& intervals) {
    std::vector<Finding> before = std::move(answer_.findings);
    answer_.findings.clear();
    for (const HoldingInterval& interval : intervals) {
      add_end("holds from", interval.from);
      add_end("holds to", interval.to);
    }
    answer_.findings.insert(answer_.findings.end(), before.begin(), before.end());
    std::size_t k = 0;
    for (const auto& [x, value] : known_) {
      const std::string name = "value " + std::to_string(++k);
      answer_.findings.push_back({"design", name, variable_.name, x});
      answer_.findings.push_back({"design", name, "margin", signed_margin(value)});
      answer_.findings.back().status = value.doubt;
    }
  }

  void add_notes(const LineSamples& samples) {
    if (!is_list())
      answer_.notes.push_back(
          "Values were looked at " + quantity((variable_.range[1] - variable_.range[0]) / static_cast<double>(settings_.points - 1)) +
          " apart, and closer where the margin turns: an interval narrower than that, in which limits hold or do not, can "
          "be missed; 'points' looks closer.");
    if (target_ && !is_list())
      answer_.notes.emplace_back(
          "Between its ends the reliability index is of first order. At the ends it is of samples, with the interval.");
    const auto doubtful = std::count_if(known_.begin(), known_.end(), [](const auto& one) { return !one.second.doubt.empty(); });
    if (doubtful == 0) return;
    const auto first = std::find_if(known_.begin(), known_.end(), [](const auto& one) { return !one.second.doubt.empty(); });
    answer_.notes.push_back(counted(static_cast<std::size_t>(doubtful), "value has", "values have") +
                            " no trusted result and count as not holding, first " + quantity(first->first) + ": " + first->second.doubt);
    if (std::all_of(samples.g.begin(), samples.g.end(), [](double g) { return g < 0.0; })) answer_.degrade(Standing::not_met);
  }

  StudyRun& run_;
  const DesignSettings& settings_;
  std::size_t sought_;
  const Variable& variable_;
  std::optional<double> target_;
  TargetSearch search_;
  std::map<double, DesignValue> known_;     ///< results by value of the design variable
  std::map<double, std::size_t> governing_; ///< index of the least limit state, by value of the design variable
  Answer answer_;
};

Answer run_design(StudyRun& run) { return is_choice(run.study()) ? cheapest_option(run) : Design(run).answer(); }

} // namespace

StudyKind design_kind() {
  StudyKind kind;
  kind.name = "design";
  kind.doc = "the values of a variable with which all limits hold, for certain or with a target reliability, or the cheapest of several";
  kind.fields = design_fields();
  kind.holds<DesignSettings>();
  kind.shown = {"beta", "p", "confidence"};
  kind.draws_jointly = true;
  kind.seeks_a_mean = true;
  kind.begins_with_sentence = true;
  kind.parts = {{"holds from", "holds from", UnitOf::subject},
                {"holds to", "holds to", UnitOf::subject},
                {"border of first order", "border of first order", UnitOf::subject},
                {"checked at", "checked at", UnitOf::subject},
                {"cost", "cost"},
                {"margin", "margin"}};
  kind.points = {{"design", "value", true}, {"design", "option"}};
  kind.prepare = prepare_design;
  kind.check = check_design;
  kind.run = run_design;
  return kind;
}

} // namespace steplap::study
