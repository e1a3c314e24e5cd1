#include "mbd/run/second_opinion.h"

#include "mbd/base/counter_random.h"
#include "mbd/base/number_text.h"
#include "mbd/model/method.h"
#include "mbd/run/prominence.h"
#include "mbd/trust/audit.h"
#include "mbd/trust/cross_check.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judge.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

namespace {

// Limit for a run of either method: this multiple of the evaluations of the checked run.
constexpr long k_most_times = 10;
constexpr double k_always_granted = 3e7; // evaluated parts (global_error.h) that are always permitted; they take a few seconds
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

// Counts the runs of the other method that violate an event criterion which the checked run meets. A single violation is not conclusive,
// because a slip can be lost between two samples.
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
      for (MetCriterion& met : met_)
        if (c.name == met.name && c.text == met.text && c.outcome != Verdict::hold && c.outcome != Verdict::open) {
          ++met.contradictions;
          met.where = c.where + (c.t ? "' at t = " + number_text(*c.t) + " s" : "'");
        }
  }

  /// Returns a criterion that all runs of the other method violate; "" if there is none.
  [[nodiscard]] std::string contradiction() const {
    for (const MetCriterion& met : met_)
      if (runs_ > 0 && met.contradictions == runs_) return "'" + met.name + "', " + met.text + ": not met by '" + met.where;
    return "";
  }

private:
  struct MetCriterion {
    std::string name, text, where;
    int contradictions = 0;
  };
  const Model& model_;
  const System& system_;
  std::vector<MetCriterion> met_;
  int runs_ = 0;
};

constexpr double k_drawn_share = 1.0 / 3.0; // largest mean of the random steps, relative to the mean step of the checked run
constexpr std::uint64_t k_drawn_seed = 42;  // constant seed, so that repeated checks of a run use the same steps

// Returns the end times of steps with random lengths.
std::vector<double> drawn_times(double end, double mean) {
  std::vector<double> times;
  double t = 0.0;
  for (std::uint64_t i = 0;; ++i) {
    t += mean * (0.5 + counter_uniform(k_drawn_seed, 0, i, 0));
    if (!(t < end)) return times;
    times.push_back(t);
  }
}

std::unique_ptr<System> compiled_for_audit(const Model& model) {
  std::unique_ptr<System> system = compile(model); // a second system with its own channels
  add_audit_channels(*system, model);
  return system;
}

// Runs of other methods than that of the checked run.
class SecondOpinionRuns {
public:
  SecondOpinionRuns(const Run& asked, const RunOptions& options)
      : loaded_(*asked.loaded), run_(asked.result), run_options_(options), as_run_(options_of(loaded_.model)),
        system_(compiled_for_audit(loaded_.model)), used_(method_used(*system_, as_run_)) {}

  SecondOpinion time_stepping() { return ask(other_method(as_run_)); }

  // Runs an event-locating method with random step lengths: tsit5, or rodas5p if tsit5 needs too many evaluations.
  SecondOpinion drawn_steps() {
    const double mean = k_drawn_share * as_run_.end / static_cast<double>(std::max(run_.statistics.steps, 1L));
    const std::unique_ptr<System> stopping = compiled_for_audit(loaded_.model);
    for (const double t : drawn_times(as_run_.end, mean)) stopping->breakpoints.push_back(t);
    std::sort(stopping->breakpoints.begin(), stopping->breakpoints.end());
    SecondOpinion opinion;
    for (const char* const name : {"tsit5", "rodas5p"}) {
      if (as_run_.integrator == name) continue;
      const double tolerance = std::max(as_run_.settings.tolerance, k_finest_drawn);
      opinion = ask({name,
                     {{name, tolerance, false}, {name, 0.1 * tolerance, false}},
                     stopping.get(),
                     1.5 * mean}); // an action would continue in another system
      opinion.drawn_step = mean;
      if (opinion.none_because.empty()) break;
    }
    return opinion;
  }

private:
  static constexpr double k_finest_drawn = 1e-9; // smallest step, s; a tenth of it is still above rounding

  SecondOpinion ask(CrossMethod other) {
    CrossCheckOptions options;
    options.methods = {used_, std::move(other)};
    options.cpu_limit = std::numeric_limits<double>::infinity();
    const double parts = evaluation_cost(*system_, run_.statistics) / static_cast<double>(std::max(run_.statistics.evaluations, 1L));
    options.evaluation_limit =
        std::max(k_most_times * run_.statistics.evaluations, static_cast<long>(k_always_granted / std::max(parts, 1.0)));
    options.is_event_counted = is_main_event;
    options.free_groups = free_groups(loaded_.model, *system_);
    SimulationOptions base = sampled_for_comparison(loaded_.model);
    base.progress = simulation_options(loaded_, run_options_).progress;
    const std::string name = options.methods.back().integrator;
    EventCriteria criteria(loaded_.model, *system_, run_);
    options.note_level = [&](const MethodSetting& level, const RunResult& result) {
      if (level.integrator == name) criteria.note(result);
    };
    const State initial = run_options_.start ? *run_options_.start : initial_state_of(loaded_);
    const CrossCheck check = cross_check(*system_, initial, base, options);
    SecondOpinion opinion;
    opinion.method = check.runs.back().setting.text();
    opinion.worst_ratio = check.worst_ratio;
    opinion.known_until = check.known_until;
    for (const CrossRun& r : check.runs)
      if (!r.failure.empty() && opinion.none_because.empty()) opinion.none_because = r.setting.text() + " " + r.failure;
    if (!opinion.none_because.empty()) return opinion;
    if (check.outcome == CrossOutcome::disagree) opinion.disagreement = text_of(check.disagreements.front());
    else if (const std::string what = criteria.contradiction(); !what.empty()) opinion.disagreement = name + ": " + what;
    else if (check.known_until == 0.0) opinion.none_because = "its steps are too coarse for what happens here";
    return opinion;
  }

  const LoadedModel& loaded_;
  const RunResult& run_;
  const RunOptions& run_options_;
  SimulationOptions as_run_;
  std::unique_ptr<System> system_;
  CrossMethod used_;
};

} // namespace

SecondOpinion second_opinion(const Run& asked, const RunOptions& options, bool is_alone) {
  SecondOpinionRuns asker(asked, options);
  SecondOpinion opinion = asker.time_stepping();
  const bool is_enough =
      opinion.none_because.empty() && (!is_alone || !opinion.disagreement.empty() || opinion.reaches(asked.result.final_state.t));
  if (is_enough || method(options_of(asked.loaded->model).integrator).is_time_stepping) return opinion;
  SecondOpinion drawn = asker.drawn_steps();
  const bool says_more = !opinion.none_because.empty() || !drawn.disagreement.empty() || drawn.known_until > opinion.known_until;
  if (drawn.none_because.empty() && says_more) return drawn;
  if (!opinion.none_because.empty()) opinion.none_because += "; with steps drawn at random " + drawn.none_because;
  return opinion;
}

} // namespace steplap
