#include "mbd/trust/accuracy_study.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/trust/global_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace steplap {

namespace {

constexpr double k_slope_ceiling = 1e-2; // larger errors do not follow the tolerance yet and are not used in the fit
constexpr double k_slope_floor = 10.0;   // times the resolution; smaller errors would be dominated by that of the reference
constexpr long k_steps_between_checks = 512;

constexpr double k_cost_power = 0.2;  // number of steps ~ tolerance^(−1/5): order 5
constexpr double k_least_cost = 1e-6; // s; replaces a measured time of zero
constexpr double k_small_part = 0.02; // fraction of the budget; only shorter runs are repeated to measure their time

struct OutOfTime : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

// Runs to the end. Throws OutOfTime if that takes more than `cpu_limit` seconds of CPU time.
RunResult run_within(const System& system, const State& initial, const SimulationOptions& options, double cpu_limit) {
  const double start = thread_cpu_seconds();
  Simulation simulation(system, initial, options);
  for (long steps = 0; simulation.advance(); ++steps)
    if (steps % k_steps_between_checks == 0 && thread_cpu_seconds() - start > cpu_limit)
      throw OutOfTime("needs more than " + number_text(cpu_limit) + " s of CPU time; at t = " + rounded_text(simulation.state().t, 12) +
                      " s by then");
  return std::move(simulation).result();
}

SimulationOptions without_samples(SimulationOptions options) {
  options.output_step = 0.0;
  options.has_extremes = false;
  return options;
}

double residual_part(const RunStatistics& s) {
  return s.energy_exchanged > 0.0 ? s.energy_residual / s.energy_exchanged : s.energy_residual;
}

class Study {
public:
  Study(const System& system, const State& initial, const SimulationOptions& base, const AccuracyOptions& options)
      : system_(system), initial_(initial), base_(base), options_(options) {}

  AccuracyStudy made() {
    make_reference();
    climb();
    mark_pareto();
    return std::move(study_);
  }

private:
  void say(const std::string& text) const {
    if (options_.progress) options_.progress(text);
  }

  RunResult reference_run(const MethodSetting& setting) {
    say("reference " + setting.text());
    try {
      return run_within(system_, initial_, setting.applied_to(base_), options_.cpu_limit);
    } catch (const NumericalFailure& failure) {
      throw NumericalFailure("no reference: " + setting.text() + " failed: " + failure.what());
    }
  }

  void make_reference() {
    study_.first_reference = options_.first_reference;
    study_.second_reference = options_.second_reference;
    reference_ = reference_run(options_.first_reference);
    const RunResult second = reference_run(options_.second_reference);
    study_.resolution = compare_runs(system_, second, reference_, options_.is_event_counted);
    if (study_.is_resolved(ErrorKind::position)) return;
    const WorstError& worst = study_.resolution.of(ErrorKind::position);
    throw NumericalFailure("no reference: " + options_.first_reference.text() + " and " + options_.second_reference.text() + " differ by " +
                           rounded_text(worst.value, 3) + " of range in '" + worst.where + "' at t = " + rounded_text(worst.t, 12) +
                           " s, more than " + number_text(k_agreement) +
                           ": the motion magnifies rounding beyond the resolution of any run. A shorter run or other "
                           "references may do.");
  }

  // Settings of one integrator, from the coarsest to the finest, and the results so far.
  struct SettingSequence {
    std::vector<std::size_t> rungs; ///< indices in AccuracyOptions::ladder
    std::size_t next = 0;
    double last_cost = 0.0, last_value = 0.0; ///< CPU time of all runs at the last setting, s, and its tolerance or step

    [[nodiscard]] bool is_over() const { return next == rungs.size(); }
  };

  // Returns the predicted CPU time of the next setting, s, proportional to 1/step or tolerance^(−k_cost_power). The prediction is 0 for the
  // first setting, so that every integrator is measured at least once.
  [[nodiscard]] double predicted(const SettingSequence& climb) const {
    const MethodSetting& setting = options_.ladder[climb.rungs[climb.next]];
    if (climb.last_cost == 0.0) return 0.0;
    const double finer = climb.last_value / setting.value;
    return climb.last_cost * (setting.is_step ? finer : portable::pow(finer, k_cost_power));
  }

  [[nodiscard]] std::vector<SettingSequence> climbs() const {
    std::map<std::string, SettingSequence> by_name;
    std::vector<std::string> order;
    for (std::size_t i = 0; i < options_.ladder.size(); ++i) {
      SettingSequence& climb = by_name[options_.ladder[i].integrator];
      if (climb.rungs.empty()) order.push_back(options_.ladder[i].integrator);
      climb.rungs.push_back(i);
    }
    std::vector<SettingSequence> list;
    for (const std::string& name : order) {
      std::stable_sort(by_name[name].rungs.begin(), by_name[name].rungs.end(),
                       [this](std::size_t a, std::size_t b) { return options_.ladder[a].value > options_.ladder[b].value; });
      list.push_back(std::move(by_name[name]));
    }
    return list;
  }

  // Runs the settings of all integrators, always the one with the least predicted cost next, so that the budget covers as many as possible.
  void climb() {
    study_.budget = options_.budget;
    study_.entries.resize(options_.ladder.size());
    std::vector<SettingSequence> list = climbs();
    for (;;) {
      SettingSequence* cheapest = nullptr;
      for (SettingSequence& climb : list)
        if (!climb.is_over() && (!cheapest || predicted(climb) < predicted(*cheapest))) cheapest = &climb;
      if (!cheapest) return;
      const std::size_t rung = cheapest->rungs[cheapest->next];
      const MethodSetting& setting = options_.ladder[rung];
      const double cost = predicted(*cheapest);
      if (study_.spent + cost > options_.budget) {
        study_.entries[rung] = left_out(setting);
      } else {
        const double start = thread_cpu_seconds();
        study_.entries[rung] = entry(setting);
        cheapest->last_cost = std::max(thread_cpu_seconds() - start, k_least_cost);
        cheapest->last_value = setting.value;
        study_.spent += cheapest->last_cost;
      }
      ++cheapest->next;
    }
  }

  [[nodiscard]] double left() const { return std::max(0.0, options_.budget - study_.spent); }

  [[nodiscard]] AccuracyEntry left_out(const MethodSetting& setting) const {
    AccuracyEntry e;
    e.setting = setting;
    e.is_left_out = true;
    e.failure = "left out: beyond the budget of " + number_text(options_.budget) + " s of CPU time";
    return e;
  }

  AccuracyEntry entry(const MethodSetting& setting) {
    say(setting.text());
    const double limit = std::min(options_.cpu_limit, left());
    AccuracyEntry e;
    e.setting = setting;
    try {
      const RunResult sampled = run_within(system_, initial_, setting.applied_to(base_), limit);
      e.error = compare_runs(system_, sampled, reference_, options_.is_event_counted);
      e.energy_residual = residual_part(sampled.statistics);
      e.constraint_residual = sampled.statistics.max_position_residual;
      measure_cost(e);
      if (!std::isfinite(study_.error_of(e))) e.failure = "the result is no number";
    } catch (const OutOfTime& failure) {
      if (limit < options_.cpu_limit) return left_out(setting);
      e.failure = failure.what();
    } catch (const NumericalFailure& failure) {
      e.failure = failure.what();
    }
    return e;
  }

  void measure_cost(AccuracyEntry& e) {
    for (int i = 0; i < std::max(1, options_.repeats); ++i) {
      const double start = thread_cpu_seconds();
      const RunResult run = run_within(system_, initial_, without_samples(e.setting.applied_to(base_)), options_.cpu_limit);
      const double spent = thread_cpu_seconds() - start;
      e.cpu_seconds = i == 0 ? spent : std::min(e.cpu_seconds, spent);
      e.cost = run.statistics;
      if (spent > k_small_part * options_.budget) return;
    }
  }

  void mark_pareto() {
    for (AccuracyEntry& e : study_.entries) {
      if (!e.failure.empty()) continue;
      const double error = study_.error_of(e);
      e.is_pareto = std::none_of(study_.entries.begin(), study_.entries.end(), [&](const AccuracyEntry& other) {
        if (&other == &e || !other.failure.empty()) return false;
        const double their = study_.error_of(other);
        return their <= error && other.cpu_seconds <= e.cpu_seconds && (their < error || other.cpu_seconds < e.cpu_seconds);
      });
    }
  }

  const System& system_;
  const State& initial_;
  const SimulationOptions& base_;
  const AccuracyOptions& options_;
  AccuracyStudy study_;
  RunResult reference_;
};

struct Point {
  double value, error;
};

// Returns the least-squares fit of log error = slope · log value + constant.
ErrorSlope fitted(const std::string& integrator, const std::vector<Point>& points) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, low = INFINITY, high = -INFINITY;
  for (const Point& p : points) {
    const double x = portable::log10(p.value), y = portable::log10(p.error);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  ErrorSlope s;
  s.integrator = integrator;
  s.slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  s.decades = high - low;
  return s;
}

} // namespace

std::string MethodSetting::text() const {
  return integrator + (is_step ? " h = " + rounded_text(value) + " s" : " " + rounded_text(value));
}

SimulationOptions MethodSetting::applied_to(SimulationOptions options) const {
  options.integrator = integrator;
  if (is_step) {
    options.settings.step = value;
  } else {
    options.settings.step = 0.0;
    options.settings.tolerance = value;
  }
  options.channels.clear();
  options.progress = {};
  return options;
}

bool AccuracyStudy::is_resolved(ErrorKind kind) const {
  if (kind == ErrorKind::event_time && resolution.unmatched_events > 0) return false;
  return resolution.of(kind).value <= k_agreement;
}

double AccuracyStudy::error_of(const AccuracyEntry& entry) const {
  double largest = 0.0;
  for (std::size_t k = 0; k < k_error_kinds; ++k) {
    const auto kind = static_cast<ErrorKind>(k);
    if (!is_resolved(kind)) continue;
    const double error = std::max(entry.error.of(kind).value, resolution.of(kind).value);
    if (!(error <= largest)) largest = error; // also NaN
  }
  return largest;
}

const AccuracyEntry* AccuracyStudy::cheapest(double wanted) const {
  const AccuracyEntry* best = nullptr;
  for (const AccuracyEntry& e : entries)
    if (e.failure.empty() && error_of(e) <= wanted && (!best || e.cpu_seconds < best->cpu_seconds)) best = &e;
  return best;
}

std::vector<ErrorSlope> AccuracyStudy::slopes() const {
  const double floor = k_slope_floor * std::max(resolution.of(ErrorKind::position).value, 1e-15);
  std::map<std::string, std::vector<Point>> points;
  std::set<std::string> with_steps;
  for (const AccuracyEntry& e : entries) {
    const double error = e.error.of(ErrorKind::position).value;
    if (!e.failure.empty() || !(error > floor && error < k_slope_ceiling)) continue;
    points[e.setting.integrator].push_back({e.setting.value, error});
    if (e.setting.is_step) with_steps.insert(e.setting.integrator);
  }
  std::vector<ErrorSlope> slopes;
  for (const auto& [integrator, list] : points) {
    if (list.size() < 2) continue;
    slopes.push_back(fitted(integrator, list));
    slopes.back().is_step = with_steps.count(integrator) > 0;
  }
  return slopes;
}

std::vector<MethodSetting> usual_ladder(const System& system, const std::vector<std::string>& names, double step) {
  std::vector<MethodSetting> ladder;
  for (const std::string& name : names) {
    if (is_adaptive(system, name)) {
      for (int digits = 3; digits <= 12; ++digits) // parsed from text, for the double nearest to the decimal number
        ladder.push_back({name, std::stod("1e-" + std::to_string(digits)), false});
    } else {
      for (double h = 8.0 * step; h > 0.1 * step; h *= 0.5) ladder.push_back({name, h, true});
    }
  }
  return ladder;
}

AccuracyStudy study_accuracy(const System& system, const State& initial, const SimulationOptions& base, const AccuracyOptions& options) {
  return Study(system, initial, base, options).made();
}

} // namespace steplap
