#include "run/second_opinion.h"

#include "mbd/base/number_text.h"
#include "mbd/model/method.h"
#include "mbd/trust/audit.h"
#include "mbd/trust/cross_check.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judge.h"
#include "run/prominence.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace steplap {

namespace {

// A run of either method may take so many times the evaluations of the one that is looked at, …
constexpr long k_most_times = 10;
constexpr double k_always_granted = 3e7; // … and in any case a few seconds: parts evaluated (global_error.h)
constexpr double k_second_tolerance = 1e-6;

CrossMethod method_used(const System& system, const SimulationOptions& as_run) {
  CrossMethod used{as_run.integrator, {}};
  const bool has_steps = !is_adaptive(system, as_run.integrator);
  if (!has_steps) used.levels.push_back({as_run.integrator, as_run.settings.tolerance, false});
  else used.levels.push_back({as_run.integrator, as_run.settings.step, true});
  for (const SimulationOptions& finer : finer_options(system, as_run))
    used.levels.push_back({as_run.integrator, has_steps ? finer.settings.step : finer.settings.tolerance, has_steps});
  return used;
}

CrossMethod other_method(const SimulationOptions& as_run) {
  if (method(as_run.integrator).is_time_stepping)
    return {"dop853", {{"dop853", k_second_tolerance, false}, {"dop853", 0.01 * k_second_tolerance, false}}};
  for (CrossMethod& usual : usual_methods(as_run.end, as_run.settings.tolerance, as_run.settings.step))
    if (method(usual.integrator).is_time_stepping) return std::move(usual);
  return {};
}

std::string text_of(const Disagreement& d) {
  std::string text = d.first + (d.second.empty() ? "" : " and " + d.second) + ": " + name_of(d.doubt);
  if (!d.where.empty()) text += " " + d.where + " at t = " + number_text(d.t) + " s";
  return d.text.empty() ? text : text + ", " + d.text;
}

// How often the other method's runs do not meet a criterion about events that the run in question meets: whether something
// slips at all is no matter of digits, and may be lost between two samples.
class EventCriteria {
public:
  EventCriteria(const Model& model, const System& system, const RunResult& run) : model_(model), system_(system) {
    for (const CriterionResult& c : judge(model, system, run, "").criteria)
      if (!c.value && c.outcome == Verdict::hold) met_.push_back({c.name, c.text, "", 0});
  }

  void note(const RunResult& other) {
    ++runs_;
    const Judgement judgement = judge(model_, system_, other, "");
    for (const CriterionResult& c : judgement.criteria)
      for (Met& met : met_)
        if (c.name == met.name && c.text == met.text && c.outcome != Verdict::hold && c.outcome != Verdict::open) {
          ++met.contradictions;
          met.where = c.where + (c.t ? "' at t = " + number_text(*c.t) + " s" : "'");
        }
  }

  /// Of what none of its runs meets; empty: nothing.
  [[nodiscard]] std::string contradiction() const {
    for (const Met& met : met_)
      if (runs_ > 0 && met.contradictions == runs_) return "'" + met.name + "', " + met.text + ": not met by '" + met.where;
    return "";
  }

private:
  struct Met {
    std::string name, text, where;
    int contradictions = 0;
  };
  const Model& model_;
  const System& system_;
  std::vector<Met> met_;
  int runs_ = 0;
};

} // namespace

SecondOpinion second_opinion(const Run& asked, const RunOptions& run_options) {
  const LoadedModel& loaded = *asked.loaded;
  const RunResult& run = asked.result;
  const SimulationOptions as_run = options_of(loaded.model);
  const std::unique_ptr<System> system = compile(loaded.model); // with channels of its own
  add_audit_channels(*system, loaded.model);
  CrossCheckOptions options;
  options.methods = {method_used(*system, as_run), other_method(as_run)};
  options.cpu_limit = std::numeric_limits<double>::infinity();
  const double parts = parts_evaluated(*system, run.statistics) / static_cast<double>(std::max(run.statistics.evaluations, 1L));
  options.evaluation_limit =
      std::max(k_most_times * run.statistics.evaluations, static_cast<long>(k_always_granted / std::max(parts, 1.0)));
  options.is_event_counted = is_main_event;
  options.free_groups = free_groups(loaded.model, *system);
  SimulationOptions base = sampled_for_comparison(loaded.model);
  base.progress = simulation_options(loaded, run_options).progress;
  const std::string other = options.methods.back().integrator;
  EventCriteria criteria(loaded.model, *system, run);
  options.note_level = [&](const MethodSetting& level, const RunResult& result) {
    if (level.integrator == other) criteria.note(result);
  };
  const CrossCheck check = cross_check(*system, run_options.start ? *run_options.start : initial_state_of(loaded), base, options);
  SecondOpinion opinion;
  opinion.method = check.runs.back().setting.text();
  opinion.worst_ratio = check.worst_ratio;
  opinion.known_until = check.known_until;
  for (const CrossRun& r : check.runs)
    if (!r.failure.empty() && opinion.none_because.empty()) opinion.none_because = r.setting.text() + " " + r.failure;
  if (!opinion.none_because.empty()) return opinion;
  if (check.outcome == CrossOutcome::disagree) opinion.disagreement = text_of(check.disagreements.front());
  else if (const std::string what = criteria.contradiction(); !what.empty()) opinion.disagreement = other + ": " + what;
  else if (check.known_until == 0.0) opinion.none_because = "its steps are too coarse for what happens here";
  return opinion;
}

} // namespace steplap
