#include "tools/study/design_choice.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "tools/study/case_limits.h"
#include "tools/study/design.h"
#include "tools/study/expression.h"
#include "tools/study/grid.h"
#include "tools/study/holding.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

constexpr double k_most_options = 100000; // largest number of combinations that may be run

/// One combination of values of the design variables.
struct Option {
  std::vector<double> values; ///< values of all variables of the study
  double cost = 0.0;
  double margin = 0.0;  ///< least limit state; negative: the limits do not hold
  std::size_t limit{};  ///< index of the least limit state
  bool is_open = false; ///< true if it is unknown whether the limits hold
  std::string reason{}; ///< why the limits do not hold, or why this is unknown; "" if they hold

  [[nodiscard]] bool holds() const { return reason.empty(); }
};

bool is_design_variable(const Variable& v) { return !v.values.empty(); }

std::vector<std::vector<double>> levels_of(const LoadedStudy& loaded) {
  std::vector<std::vector<double>> levels;
  for (std::size_t i = 0; i < loaded.nominal.size(); ++i) {
    const std::vector<double>& values = loaded.study.variables[i].values;
    levels.push_back(values.empty() ? std::vector<double>{loaded.nominal[i]} : values);
  }
  return levels;
}

Expression cost_of(const LoadedStudy& loaded) {
  const auto& s = settings_of<DesignSettings>(loaded.study);
  return {s.cost, loaded.variable_names(), s.where};
}

class Choice {
public:
  explicit Choice(StudyRun& run) : run_(run) {}

  Answer answer() {
    run_options();
    std::stable_sort(options_.begin(), options_.end(), [](const Option& a, const Option& b) { return a.cost < b.cost; });
    best_ = std::find_if(options_.begin(), options_.end(), [](const Option& o) { return o.holds(); });
    answer_.notes.push_back(sentence());
    if (best_ == options_.end()) answer_.degrade(Standing::not_met);
    add_open_options();
    std::stable_partition(options_.begin(), options_.end(), [](const Option& o) { return o.holds(); });
    for (const Option& option : options_) add_findings(option);
    return std::move(answer_);
  }

private:
  void run_options() {
    const Expression cost = cost_of(run_.loaded);
    std::vector<double> points;
    visit_grid(levels_of(run_.loaded), [&](const std::vector<double>& values) {
      options_.push_back({values, cost(values.data())});
      points.insert(points.end(), values.begin(), values.end());
    });
    run_.evaluator.expect(static_cast<long>(options_.size()));
    const std::vector<StoredSample>& rows = run_.evaluator.evaluate(points);
    for (std::size_t i = 0; i < options_.size(); ++i) judge(rows[i].outcome, options_[i]);
  }

  void judge(const Outcome& outcome, Option& option) const {
    const auto first = outcome.numbers.begin() + static_cast<long>(run_.study().responses.size());
    const auto least = std::min_element(first, outcome.numbers.end());
    option.margin = *least;
    option.limit = static_cast<std::size_t>(least - first);
    const bool is_undecided = outcome.status == SampleStatus::undecided && *least == 0.0,
               is_unknown = outcome.status != SampleStatus::ok && outcome.status != SampleStatus::undecided;
    option.is_open = is_undecided || is_unknown;
    if (option.is_open) option.reason = outcome.reason;
    else if (option.margin < 0.0) option.reason = "limit state '" + run_.study().limit_states[option.limit].name + "' is negative";
  }

  // Returns the reason why a limit is exceeded, from a complete run of the model, which also gives the amount.
  [[nodiscard]] std::string full_reason(const Option& option) const {
    const StudyModel* model = model_of_limit(run_.loaded, option.limit);
    if (!model || option.is_open) return option.reason;
    return (model->load ? "in case '" + model->name + "' " : "") + reason_of_verdict(run_.loaded, *model, option.values.data());
  }

  [[nodiscard]] std::string values_text(const Option& option) const {
    std::string text;
    for (std::size_t i = 0; i < option.values.size(); ++i) {
      const Variable& v = run_.study().variables[i];
      if (is_design_variable(v))
        text += (text.empty() ? "'" : ", '") + v.name + "' = " + rounded_quantity(option.values[i], v.unit, false, 12);
    }
    return text;
  }

  [[nodiscard]] std::string sentence() const {
    const auto held = std::count_if(options_.begin(), options_.end(), [](const Option& o) { return o.holds(); });
    if (held == 0) {
      const auto nearest =
          std::max_element(options_.begin(), options_.end(), [](const Option& a, const Option& b) { return a.margin < b.margin; });
      return "None of " + counted(options_.size(), "option", "options") + " holds. Nearest is " + values_text(*nearest) + ": " +
             full_reason(*nearest);
    }
    return "The cheapest of " + counted(static_cast<std::size_t>(held), "option that holds", "options that hold") + ", of " +
           std::to_string(options_.size()) + " tried, is " + values_text(*best_) + " at a cost of " + rounded_text(best_->cost, 6) + "." +
           (best_ == options_.begin() ? ""
                                      : " The next cheaper one, " + values_text(best_[-1]) + ", does not hold: " + full_reason(best_[-1]));
  }

  // Notes the open options that are cheaper than the chosen one, because any of them might be the better choice.
  void add_open_options() {
    const auto open = std::count_if(options_.begin(), best_, [](const Option& o) { return o.is_open; });
    if (open == 0) return;
    answer_.degrade(Standing::not_met);
    answer_.notes.push_back(
        counted(static_cast<std::size_t>(open), "cheaper option is open and counts", "cheaper options are open and count") +
        " as not holding: see the remarks");
  }

  void add_findings(const Option& option) {
    const std::string name = "option " + std::to_string(++listed_);
    const auto put = [&](const std::string& quantity, double value, const std::string& status) {
      Finding f{"design", name, quantity, value};
      f.samples = run_.evaluator.asked();
      f.status = status;
      answer_.findings.push_back(std::move(f));
    };
    for (std::size_t i = 0; i < option.values.size(); ++i)
      if (const Variable& v = run_.study().variables[i]; is_design_variable(v)) put(v.name, option.values[i], "");
    put("cost", option.cost, "");
    put("margin", option.margin, option.reason);
  }

  StudyRun& run_;
  std::vector<Option> options_;
  std::vector<Option>::iterator best_; ///< the cheapest option that holds; options_.end() if there is none
  Answer answer_;
  long listed_ = 0;
};

} // namespace

bool is_choice(const Study& study) { return !settings_of<DesignSettings>(study).cost.empty(); }

void check_choice(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const auto& s = settings_of<DesignSettings>(loaded.study);
  if (s.beta || s.p) problems.push_back({s.where, "a choice by 'cost' is of options that hold for certain: leave 'beta' and 'p' out"});
  double count = 1.0;
  for (const Variable& v : loaded.study.variables) {
    if (!v.range.empty() || v.has_distribution())
      problems.push_back({v.where, "variable '" + v.name + "': a choice by 'cost' is among 'values', or whole numbers of a short 'range'"});
    count *= v.values.empty() ? 1.0 : static_cast<double>(v.values.size());
  }
  if (count > k_most_options)
    problems.push_back({s.where, "there are " + number_text(count) + " options: too many to run all; give fewer values"});
  if (!problems.empty()) return;
  try {
    const Expression cost = cost_of(loaded);
    visit_grid(levels_of(loaded), [&](const std::vector<double>& values) {
      if (problems.empty() && !std::isfinite(cost(values.data())))
        problems.push_back({s.where, "'cost' has no finite value for some of the options"});
    });
  } catch (const ModelError& error) {
    problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
  }
}

Answer cheapest_option(StudyRun& run) { return Choice(run).answer(); }

} // namespace steplap::study
