#include "mbd/trust/cross_check.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/method.h"
#include "mbd/simulation/energy_account.h"
#include "mbd/trust/cross_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

namespace steplap {

namespace {

// Floors of error estimates, relative to a channel's scale. Estimates of adaptive methods can be too small, because some errors do not
// follow the tolerance (location of the end of a slip, projection).
constexpr double k_floor = 1e-7, k_reaction_floor = 1e-6, k_time_floor = 1e-6;
constexpr double k_integral_floor = 1e-6;
constexpr double k_energy_allowed = 1e-5;        // largest residual of energy over the energy exchanged, adaptive runs
constexpr double k_stepped_energy_allowed = 0.2; // largest residual for fixed steps, which damp
// Largest violation of a law, as a fraction of the run's own powers and forces, for adaptive methods and for fixed steps.
constexpr double k_law_share = 1e-6, k_stepped_law_share = 1e-2;
// Ratio of a residual or violation to that at twice the step, below which it counts as decreasing with the step.
constexpr double k_shrinking = 0.8;
// Number of consecutive samples in which a difference must occur. In time stepping forces are averages over a step, so single samples do
// not count.
constexpr int k_persistent = 4;
constexpr double k_brief_steps = 20.0; // events of an element nearer to each other than so many fixed steps are not compared
constexpr double k_own_doubt = 1e-3;   // own error of an adaptive method above which it is reported
constexpr double k_momentum_allowed = 1e-6;
constexpr double k_rest_share = 1e-9; // fraction of the bodies' size: smaller position errors count as rest (run_comparison.cpp)
// Position error that counts as rest, over tolerance times the size of the bodies: 100 · 1e-3, because errors are controlled to 1e-3 of the
// size (Integrator).
constexpr double k_rest_errors = 0.1;
constexpr long k_steps_between_checks = 8; // limits are checked every so many steps, since a step of time stepping may take milliseconds
constexpr double k_closer = 0.25;          // factor on steps and sample spacing in a repetition

constexpr double k_moreau_steps = 2000, k_rk4_steps = 4000; // number of steps of the coarsest run

// Runs to the end. Throws NumericalFailure beyond the limit of evaluations, or beyond `cpu_limit` seconds of CPU time.
RunResult run_within(const System& system, const State& initial, const SimulationOptions& options, const CrossCheckOptions& limits,
                     double cpu_limit) {
  const double start = thread_cpu_seconds();
  Simulation simulation(system, initial, options);
  const auto stop = [&simulation](const std::string& what) {
    throw NumericalFailure("needs more than " + what + "; at t = " + number_text(simulation.state().t) + " s by then");
  };
  for (long steps = 0; simulation.advance(); ++steps) {
    if (steps % k_steps_between_checks != 0) continue;
    if (thread_cpu_seconds() - start > cpu_limit) stop(rounded_text(cpu_limit, 2) + " s of CPU time, its part of what all may take");
    if (simulation.statistics().evaluations > limits.evaluation_limit) stop(std::to_string(limits.evaluation_limit) + " evaluations");
  }
  return std::move(simulation).result();
}

bool is_finite(const System& system, const RunResult& run) {
  const Trajectory& t = *run.trajectory;
  std::set<std::string> bodies;
  for (const BodyData& body : system.bodies) bodies.insert(body.name);
  for (std::size_t c = 0; c < t.channels().size(); ++c) {
    const Channel& channel = *t.channels()[c];
    const bool is_force = channel.unit == "N" || channel.unit == "N m", is_rate = channel.unit == "m/s" || channel.unit == "rad/s";
    // Other channels may be infinite by definition, or without value, as the slip rate of an element that was released.
    if (!is_force && !(is_rate && bodies.contains(channel.name.substr(0, channel.name.rfind('.'))))) continue;
    for (std::size_t row = 0; row < t.size(); ++row)
      if (!std::isfinite(t.value(row, c))) return false;
  }
  return std::isfinite(run.statistics.dissipated) && std::isfinite(run.statistics.work);
}

class CrossChecker {
public:
  CrossChecker(const System& system, const State& initial, const SimulationOptions& base, const CrossCheckOptions& options)
      : system_(system), initial_(initial), base_(base), options_(options) {
    for (const FrictionUnit& unit : system.frictions) friction_names_.insert(system.element_names[unit.element]);
    is_counted_ = [this](const Event& event) {
      return friction_names_.count(event.element) > 0 && (!options_.is_event_counted || options_.is_event_counted(event));
    };
  }

  CrossCheck made() {
    for (const CrossMethod& method : options_.methods) run(method, static_cast<double>(options_.methods.size() - check_.runs.size()));
    make_curves();
    for (std::size_t i = 0; i < curves_.size(); ++i) check_laws(i);
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      for (std::size_t j = i + 1; j < curves_.size(); ++j) compare(i, j);
    }
    check_own();
    conclude();
    return std::move(check_);
  }

private:
  struct Method {
    std::size_t run = 0; ///< index in check_.runs
    std::vector<RunResult> coarser;
    bool is_adaptive = true;
    double tolerance = 0.0; ///< tolerance of the coarsest run
  };

  // Runs all settings of a method within its part of the remaining CPU time. `methods_left`: number of methods still to be run, with this
  // one.
  void run(const CrossMethod& method, double methods_left) {
    CrossRun made;
    Method levels;
    made.setting = method.levels.back();
    levels.run = check_.runs.size();
    levels.is_adaptive = !made.setting.is_step;
    levels.tolerance = levels.is_adaptive ? method.levels.front().value : 0.0;
    const double start = thread_cpu_seconds();
    const double granted = (options_.cpu_limit - (start - start_)) / methods_left;
    try {
      for (const MethodSetting& level : method.levels) {
        if (options_.progress) options_.progress(level.text());
        SimulationOptions as_asked = level.applied_to(base_);
        if (method.longest_step > 0.0) as_asked.settings.max_step = method.longest_step;
        RunResult result =
            run_within(method.system ? *method.system : system_, initial_, as_asked, options_, granted - (thread_cpu_seconds() - start));
        if (options_.note_level) options_.note_level(level, result);
        if (&level == &method.levels.back()) made.result = std::move(result);
        else levels.coarser.push_back(std::move(result));
      }
      if (options_.verdict) made.verdict = options_.verdict(made.result);
    } catch (const NumericalFailure& failure) {
      made.failure = failure.what();
    }
    made.cpu_seconds = thread_cpu_seconds() - start;
    check_.runs.push_back(std::move(made));
    if (check_.runs.back().failure.empty()) methods_.push_back(std::move(levels));
  }

  // Computes the error estimates of all methods. Must be called after all runs, because the estimates keep pointers to elements of
  // check_.runs.
  void make_curves() {
    std::vector<Method> sound;
    for (Method& method : methods_) {
      const CrossRun& r = check_.runs[method.run];
      bool is_number = is_finite(system_, r.result);
      for (const RunResult& coarser : method.coarser) is_number = is_number && is_finite(system_, coarser);
      if (is_number) sound.push_back(std::move(method));
      else note({DisagreementKind::not_a_number, r.setting.integrator, "", "", 0.0, INFINITY, "the result is no number"});
    }
    methods_ = std::move(sound);
    if (methods_.empty()) return;
    std::vector<const RunResult*> finest;
    for (const Method& method : methods_) finest.push_back(&check_.runs[method.run].result);
    channels_ = compared_channels(system_, finest);
    for (const Method& method : methods_) {
      CrossRun& r = check_.runs[method.run];
      std::vector<const RunResult*> levels;
      for (const RunResult& coarser : method.coarser) levels.push_back(&coarser);
      levels.push_back(&r.result);
      curves_.push_back(
          std::make_unique<MethodCurves>(channels_, levels, r.setting.is_step ? r.setting.value : 0.0, base_.end, is_counted_));
      r.estimate = curves_.back()->largest(ErrorKind::position).value;
      r.known_until = curves_.back()->known_until();
    }
  }

  [[nodiscard]] CrossRun& run_of(std::size_t i) { return check_.runs[methods_[i].run]; }
  [[nodiscard]] const std::string& name_of_run(std::size_t i) { return run_of(i).setting.integrator; }
  [[nodiscard]] bool is_stepping(std::size_t i) { return method(run_of(i).setting.integrator).is_time_stepping; }

  // Records a disagreement. Of several with the same two runs and the same kind of doubt only the worst is kept, and each run keeps its
  // worst one.
  void note(const Disagreement& d) {
    for (CrossRun& r : check_.runs)
      if ((r.setting.integrator == d.first || r.setting.integrator == d.second) && !(d.ratio <= r.worst.ratio)) r.worst = d;
    check_.worst_ratio = std::max(check_.worst_ratio, d.ratio);
    if (d.ratio <= 1.0) return;
    for (Disagreement& known : check_.disagreements) {
      if (known.doubt != d.doubt || known.first != d.first || known.second != d.second) continue;
      if (d.ratio > known.ratio) known = d;
      return;
    }
    check_.disagreements.push_back(d);
  }

  // --- checks of one run alone

  void check_laws(std::size_t i) {
    const CrossRun& r = run_of(i);
    const double exchanged = energy_scale(system_, r.result), residual = r.result.statistics.energy_residual;
    const double allowed = (methods_[i].is_adaptive ? k_energy_allowed : k_stepped_energy_allowed) * exchanged + energy_of_rest(i);
    // In time stepping, which damps, a residual that decreases with the step is the discretisation error.
    const bool is_shrinking = !methods_[i].is_adaptive && residual < k_shrinking * methods_[i].coarser.back().statistics.energy_residual;
    // A residual that does not shrink shows that the step is too long for the model: the run is discarded.
    if (!methods_[i].is_adaptive && !is_shrinking && residual > allowed) dismiss(i);
    if (exchanged > 0.0 && methods_[i].is_adaptive)
      note({DisagreementKind::energy, name_of_run(i), "", "", base_.end, residual / allowed,
            number_text(residual) + " J of " + number_text(exchanged) + " J"});
    const bool has_steps_alone = is_stepping(i);
    const double share = methods_[i].is_adaptive ? k_law_share : k_stepped_law_share;
    const int persistent = has_steps_alone ? k_persistent : 1;
    for (const AuditFinding& f : audit(system_, r.result, share, persistent)) {
      if (!has_steps_alone)
        note({DisagreementKind::law, name_of_run(i), "", "'" + f.where + "' " + f.what, f.t, f.ratio(),
              number_text(f.value) + ", allowed " + number_text(f.bound)});
      else if (f.ratio() > 1.0 && !is_smaller_than_before(f, audit(system_, methods_[i].coarser.back(), share, persistent))) dismiss(i);
    }
    if (options_.free_groups.empty()) return;
    const AuditFinding change = momentum_change(system_, options_.free_groups, r.result);
    const double bound = methods_[i].is_adaptive ? k_momentum_allowed : k_stepped_law_share;
    note({DisagreementKind::momentum, name_of_run(i), "", "group of '" + change.where + "'", change.t, change.value / bound,
          number_text(change.value) + " of its own"});
  }

  // Returns the part of the energy residual that is allowed in any case, J: rounding, and for adaptive methods the error that the tolerance
  // permits in steps at rest.
  double energy_of_rest(std::size_t i) {
    const CrossRun& r = run_of(i);
    const RunStatistics& s = r.result.statistics;
    if (!methods_[i].is_adaptive) return s.energy_rounding;
    const int dimension = 6 * system_.body_count();
    const double of_step = EnergyAccount::step_bound(r.setting.value, dimension, 0.0, EnergyAccount::energy_of_floor(system_));
    return s.energy_rounding + k_margin * static_cast<double>(s.steps) * of_step;
  }

  // Discards a run: its time until which results are known is set to zero.
  void dismiss(std::size_t i) {
    curves_[i]->distrust();
    run_of(i).known_until = 0.0;
  }

  // Returns true if the same violation was clearly larger at twice the step, so that it is a discretisation error.
  static bool is_smaller_than_before(const AuditFinding& now, const std::vector<AuditFinding>& before) {
    return std::any_of(before.begin(), before.end(),
                       [&](const AuditFinding& f) { return f.what == now.what && now.ratio() < k_shrinking * f.ratio(); });
  }

  // Reports adaptive methods whose own error exceeds twice that of time stepping.
  void check_own() {
    const auto stepping = std::find_if(curves_.begin(), curves_.end(),
                                       [&](const auto& c) { return is_stepping(static_cast<std::size_t>(&c - curves_.data())); });
    if (stepping == curves_.end()) return;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      if (!methods_[i].is_adaptive) continue;
      for (const ErrorKind kind : {ErrorKind::position, ErrorKind::velocity}) {
        const WorstError own = curves_[i]->largest(kind);
        const double bound = std::max({k_own_doubt, 2.0 * (*stepping)->largest(kind).value, error_of_rest(i, kind, own.where)});
        note({DisagreementKind::self, name_of_run(i), "", own.where, base_.end, own.value / bound,
              "its own estimate is " + number_text(own.value) + ", time stepping's " + number_text((*stepping)->largest(kind).value)});
      }
    }
  }

  // Returns the error below which the bodies count as at rest, m; for velocities, m/s, times the natural frequency of a body on the stiffest
  // spring.
  double error_of_rest(std::size_t i, ErrorKind kind) {
    const double error = std::max(k_rest_share, k_rest_errors * methods_[i].tolerance) * size_of_bodies(system_);
    if (kind != ErrorKind::velocity) return error;
    const Trajectory& t = *run_of(i).result.trajectory;
    const UnknownColumns columns = unknown_columns(t);
    double rate = 0.0; // 1/s
    for (std::size_t row = 0; row < t.size(); ++row)
      if (const double place = t.value(row, columns.place); place > 0.0) rate = std::max(rate, t.value(row, columns.rate) / place);
    return error * rate;
  }
  // The same relative to the scale of a channel.
  double error_of_rest(std::size_t i, ErrorKind kind, const std::string& where) {
    const auto channel =
        std::find_if(channels_.begin(), channels_.end(), [&](const ComparedChannel& c) { return c.channel->name == where; });
    return channel == channels_.end() ? 0.0 : error_of_rest(i, kind) / (channel->arm * channel->wide_scale);
  }

  // --- comparisons of two runs

  void compare(std::size_t i, std::size_t j) {
    compare_channels(i, j);
    compare_events(i, j);
    compare_events(j, i);
    compare_integrals(i, j);
    compare_verdicts(i, j);
  }

  void compare_channels(std::size_t i, std::size_t j) {
    const MethodCurves &x = *curves_[i], &y = *curves_[j];
    const std::size_t rows = std::min(x.rows(), y.rows());
    const double until = std::min(x.known_until(), y.known_until());     // time until which both runs are known
    const UnknownColumns columns = unknown_columns(*x.run().trajectory); // the same in all runs
    const auto unknown = [&](ErrorKind kind, std::size_t row) {
      const std::size_t column = kind == ErrorKind::reaction ? columns.force : (kind == ErrorKind::velocity ? columns.rate : columns.place);
      return x.run().trajectory->value(row, column) + y.run().trajectory->value(row, column);
    };
    // Two runs of a machine at rest take the same steps. Their difference, the estimated error, is then zero and does not show what a step
    // tolerates there.
    const double rest[2] = {error_of_rest(i, ErrorKind::position) + error_of_rest(j, ErrorKind::position),
                            error_of_rest(i, ErrorKind::velocity) + error_of_rest(j, ErrorKind::velocity)};
    Disagreement worst{DisagreementKind::channel, name_of_run(i), name_of_run(j), "", 0.0, 0.0, ""};
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const ComparedChannel& channel = channels_[c];
      const bool is_reaction = channel.kind == ErrorKind::reaction;
      const double floor = (is_reaction ? k_reaction_floor : k_floor) * channel.scale;
      const double at_rest = is_reaction ? 0.0 : rest[channel.kind == ErrorKind::velocity ? 1 : 0] / channel.arm;
      // In a step in which friction reverses or a contact closes, time stepping has one force for two phases: the impulse is right, but the
      // force at an instant is not. Near events a reaction must therefore differ in k_persistent consecutive samples, if one method is time
      // stepping.
      const bool may_be_brief = is_reaction && (is_stepping(i) || is_stepping(j));
      std::array<double, k_persistent> recent{};
      for (std::size_t row = 0; row < rows && x.run().trajectory->times()[row] <= until; ++row) {
        double& ratio = recent[row % k_persistent] = 0.0;
        if (is_share(channel, *x.run().trajectory, row) || is_share(channel, *y.run().trajectory, row)) continue;
        const double distance =
            distance_at(channel, *x.run().trajectory, *y.run().trajectory, row, k_margin * (x.slack(row) + y.slack(row)));
        const double errors[2] = {x.estimate(c, row), y.estimate(c, row)};
        const bool is_blind = errors[0] == 0.0 || errors[1] == 0.0;
        const double allowed =
            k_margin * (errors[0] + errors[1]) + floor + (is_blind ? at_rest : 0.0) + unknown(channel.kind, row) / channel.arm;
        ratio = distance > 0.0 ? distance / allowed : 0.0;
        const bool is_near_event = x.slack(row) > 2.0 * x.step() || y.slack(row) > 2.0 * y.step();
        const double lasting = may_be_brief && is_near_event ? *std::min_element(recent.begin(), recent.end()) : ratio;
        if (!(lasting > worst.ratio)) continue;
        const std::string unit = channel.channel->unit.empty() ? "" : " " + channel.channel->unit;
        worst.where = channel.channel->name;
        worst.t = x.run().trajectory->times()[row];
        worst.ratio = lasting;
        worst.text = number_text(distance) + unit + ", estimates " + number_text(x.estimate(c, row)) + " and " +
                     number_text(y.estimate(c, row)) + unit;
      }
    }
    note(worst);
  }

  // Compares the events that are certain in run i with those of run j, and reports the missing ones.
  void compare_events(std::size_t i, std::size_t j) {
    const MethodCurves &x = *curves_[i], &y = *curves_[j];
    const double until = std::min(x.known_until(), y.known_until());
    const double near = std::max(k_time_floor * base_.end, k_brief_steps * std::max(x.step(), y.step()));
    const double energy_allowed = k_margin * (x.dissipated_error() + y.dissipated_error()) +
                                  k_integral_floor * std::max(energy_scale(system_, x.run()), energy_scale(system_, y.run())) +
                                  energy_of_rest(i) + energy_of_rest(j) + 1e-300;
    Disagreement worst{DisagreementKind::event, name_of_run(i), name_of_run(j), "", 0.0, 0.0, ""};
    for (const TimedEvent& event : x.events()) {
      if (!event.is_counted || !std::isfinite(event.shift) || event.t > until || event.alone < near) continue;
      // If a slip in several coordinates passes through rest within a step, time stepping cannot show it.
      if (event.kind == EventKind::changes_slip_direction && is_stepping(j)) continue;
      double distance = INFINITY, allowed = 0.0;
      bool is_doubted = false;
      for (const TimedEvent& other : y.events()) {
        if (other.element != event.element) continue;
        if (!std::isfinite(other.shift)) is_doubted |= std::abs(other.t - event.t) < 0.05 * base_.end;
        if (other.kind != event.kind || other.is_at_start != event.is_at_start || std::abs(other.t - event.t) >= distance) continue;
        distance = std::abs(other.t - event.t);
        allowed = k_margin * (event.shift + (std::isfinite(other.shift) ? other.shift : 0.0));
      }
      if (is_doubted) continue;
      // An event does not count if it dissipates less energy than the error of the energy.
      const double energy =
          std::max(x.friction_energy(event.element, event.t, event.lasts), y.friction_energy(event.element, event.t, event.lasts));
      const double ratio = std::min(std::min(distance, base_.end) / (allowed + near), energy / energy_allowed);
      if (!(ratio > worst.ratio)) continue;
      worst.where = "'" + event.element + "' " + words_of(event.kind);
      worst.t = event.t;
      worst.ratio = ratio;
      worst.text = std::isfinite(distance)
                       ? number_text(distance) + " s from the nearest, estimates allow " + number_text(allowed + near) + " s"
                       : "is missing";
    }
    note(worst);
  }

  void compare_integrals(std::size_t i, std::size_t j) {
    if (std::min(curves_[i]->known_until(), curves_[j]->known_until()) < base_.end * (1.0 - 1e-6)) return; // verdicts need the whole run
    const RunStatistics &a = run_of(i).result.statistics, &b = run_of(j).result.statistics;
    const double scale = std::max(energy_scale(system_, run_of(i).result), energy_scale(system_, run_of(j).result));
    const auto one = [&](const char* what, double x, double y, double estimates) {
      const double allowed = k_margin * estimates + k_integral_floor * scale + energy_of_rest(i) + energy_of_rest(j);
      if (allowed > 0.0)
        note({DisagreementKind::integral, name_of_run(i), name_of_run(j), what, base_.end, std::abs(x - y) / allowed,
              number_text(std::abs(x - y)) + " J, estimates " + number_text(estimates) + " J"});
    };
    one("dissipated energy", a.dissipated, b.dissipated, curves_[i]->dissipated_error() + curves_[j]->dissipated_error());
    one("work", a.work, b.work, curves_[i]->work_error() + curves_[j]->work_error());
  }

  void compare_verdicts(std::size_t i, std::size_t j) {
    const CrossRun &a = run_of(i), &b = run_of(j);
    if (a.verdict == b.verdict || std::min(a.known_until, b.known_until) < base_.end * (1.0 - 1e-6)) return;
    note({DisagreementKind::verdict, name_of_run(i), name_of_run(j), "", base_.end, INFINITY, a.verdict + " against " + b.verdict});
  }

  void conclude() {
    std::stable_sort(check_.disagreements.begin(), check_.disagreements.end(),
                     [](const Disagreement& a, const Disagreement& b) { return a.ratio > b.ratio; });
    double stepping = 0.0, other = 0.0, least = base_.end;
    bool is_any_stepping = false;
    for (const CrossRun& r : check_.runs) is_any_stepping = is_any_stepping || steplap::method(r.setting.integrator).is_time_stepping;
    for (const Method& method : methods_) {
      const CrossRun& r = check_.runs[method.run];
      double& known = steplap::method(r.setting.integrator).is_time_stepping ? stepping : other;
      known = std::max(known, r.known_until);
      least = std::min(least, r.known_until);
    }
    check_.known_until = is_any_stepping ? std::min(stepping, other) : methods_.empty() ? 0.0 : least;
    if (!check_.disagreements.empty()) check_.outcome = CrossOutcome::disagree;
    else if (check_.known_until < base_.end * (1.0 - 1e-6)) check_.outcome = CrossOutcome::vague;
  }

  const System& system_;
  const State& initial_;
  const SimulationOptions& base_;
  const CrossCheckOptions& options_;
  double start_ = thread_cpu_seconds(); ///< s
  CrossCheck check_;
  std::set<std::string> friction_names_;
  EventFilter is_counted_;
  std::vector<Method> methods_;
  std::vector<ComparedChannel> channels_;
  std::vector<std::unique_ptr<MethodCurves>> curves_;
};

// Returns true if smaller steps and denser samples could remove a disagreement, because one of its methods has fixed steps.
bool is_worth_refining(const CrossCheck& check) {
  return std::any_of(check.disagreements.begin(), check.disagreements.end(), [&](const Disagreement& d) {
    return std::any_of(check.runs.begin(), check.runs.end(), [&](const CrossRun& run) {
      const std::string& name = run.setting.integrator;
      return run.setting.is_step && (name == d.first || name == d.second);
    });
  });
}

} // namespace

const char* name_of(DisagreementKind doubt) {
  switch (doubt) {
  case DisagreementKind::channel: return "channel";
  case DisagreementKind::event: return "event";
  case DisagreementKind::verdict: return "verdict";
  case DisagreementKind::integral: return "energy account";
  case DisagreementKind::energy: return "energy balance";
  case DisagreementKind::momentum: return "momentum";
  case DisagreementKind::law: return "law";
  case DisagreementKind::not_a_number: return "not a number";
  case DisagreementKind::self: return "own estimate";
  }
  return "";
}

std::vector<CrossMethod> usual_methods(double end, double tolerance, double step) {
  const auto adaptive = [](const char* name, double coarse) {
    return CrossMethod{name, {{name, coarse, false}, {name, 0.01 * coarse, false}}};
  };
  const double stepping = end / k_moreau_steps, rk4 = step > 0.0 ? std::min(step, end / k_rk4_steps) : end / k_rk4_steps;
  return {adaptive("auto", std::max(tolerance, 1e-12)),
          adaptive("dop853", 1e-8),
          adaptive("tsit5", 1e-8),
          adaptive("rodas5p", 1e-6),
          {"rk4", {{"rk4", rk4, true}, {"rk4", 0.5 * rk4, true}}},
          {"moreau", {{"moreau", stepping, true}, {"moreau", 0.5 * stepping, true}, {"moreau", 0.25 * stepping, true}}}};
}

CrossCheck cross_check(const System& system, const State& initial, const SimulationOptions& base, const CrossCheckOptions& options) {
  const double start = thread_cpu_seconds();
  CrossCheckOptions used = options;
  if (used.methods.empty()) used.methods = usual_methods(base.end, base.settings.tolerance, base.settings.step);
  SimulationOptions sampling = base;
  CrossCheck check = CrossChecker(system, initial, sampling, used).made();
  double last = thread_cpu_seconds() - start;
  for (int look = 1; look <= options.refinements && is_worth_refining(check); ++look) {
    const double begin = thread_cpu_seconds();
    used.cpu_limit = options.cpu_limit - (begin - start);
    if (last / k_closer > used.cpu_limit) break; // the repetition would exceed the CPU time
    sampling.output_step *= k_closer;
    for (CrossMethod& method : used.methods)
      for (MethodSetting& level : method.levels)
        if (level.is_step) level.value *= k_closer;
    CrossCheck closer = CrossChecker(system, initial, sampling, used).made();
    const auto stops = [](const CrossCheck& c) {
      return std::count_if(c.runs.begin(), c.runs.end(), [](const CrossRun& r) { return !r.failure.empty(); });
    };
    if (stops(closer) > stops(check)) break; // the repetition ran out of time: keep the first result
    check = std::move(closer);
    check.refinements = look;
    last = thread_cpu_seconds() - begin;
  }
  return check;
}

SimulationOptions sampled_for_comparison(const Model& model) {
  constexpr double k_most_samples = 2000.0, k_least_samples = 400.0;
  SimulationOptions options = options_of(model);
  options.output_step = std::clamp(options.output_step, options.end / k_most_samples, options.end / k_least_samples);
  options.has_extremes = true; // verdicts are judged by extremes
  return options;
}

} // namespace steplap
