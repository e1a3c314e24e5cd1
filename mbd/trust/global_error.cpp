#include "mbd/trust/global_error.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/model/method.h"
#include "mbd/simulation/extremes.h"
#include "mbd/system/formula_channel.h"
#include "mbd/trust/event_match.h"
#include "mbd/trust/reference_runs.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>

namespace steplap {

namespace {

constexpr double k_finer_tolerance = 0.01;
constexpr double k_least_tolerance = 1e-14; // smaller tolerances are dominated by rounding
constexpr int k_division = 2;
constexpr double k_finer_step = 1.0 / k_division;
constexpr double k_finer_cost = 3.0;    // relative cost of a run with 1/100 of the tolerance; a method of order 5 takes 2.5 times the steps
constexpr double k_least_error = 1e-14; // least error relative to a channel's largest value, and to times
constexpr double k_first_order = 0.5;   // ratio of the errors if the step is halved
constexpr double k_safety = 1.5;
// Largest ratio of a finer run's error to that of the run. Above it the difference is less than a tenth of the error, and the estimate is
// useless.
constexpr double k_most_left = 0.9;
constexpr double k_stepping_safety = 3.0; // for time stepping, which locates no events
constexpr double k_little = 1e7;          // cost (evaluation_cost()) that reference runs may have even if the run was short
// Extremes near a singular position (within 1e-5 rad) are unknown: a force proportional to 1/distance is more than k_grown times its usual
// size there, and runs that come to different distances disagree by more than k_disagreed.
constexpr double k_disagreed = 0.01, k_grown = 1e3;

bool locates_events(const SimulationOptions& options) { return !method(options.integrator).is_time_stepping; }

bool takes_shorter_steps(const RunStatistics& finer, const RunStatistics& run) {
  return finer.steps > run.steps || finer.evaluations > run.evaluations;
}

// Returns the ratio of the run's error to the difference of the two runs; unknown if `fine` is not finer. For fixed steps the number of
// steps actually taken counts, too.
double factor_for(const SimulationOptions& coarse, const RunStatistics& run, const SimulationOptions& fine, const RunStatistics& finer,
                  bool has_storm) {
  if (fine.settings.step != coarse.settings.step) {
    const double part =
        std::max(fine.settings.step / coarse.settings.step, static_cast<double>(run.steps) / static_cast<double>(finer.steps));
    return part > k_most_left ? k_unknown_error : (locates_events(coarse) ? 1.0 : k_stepping_safety) / (1.0 - part);
  }
  const double part = has_storm ? k_first_order : fine.settings.tolerance / coarse.settings.tolerance;
  return part > k_most_left || !takes_shorter_steps(finer, run) ? k_unknown_error : k_safety / (1.0 - std::min(k_first_order, part));
}

double difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0; // also for equal infinities
  const double d = std::abs(a - b);
  return std::isfinite(d) ? d : k_unknown_error;
}

double difference(const std::optional<double>& a, const std::optional<double>& b) {
  if (a.has_value() != b.has_value()) return k_unknown_error;
  return a ? difference(*a, *b) : 0.0;
}

// Returns the difference of two values of a channel. A dimensionless number may have a pole, such as the margin of an unloaded element,
// which is infinite. Near a pole the digits are rounding errors, so any difference counts as unknown.
double difference(const Channel& channel, double a, double b) {
  const bool is_at_pole = channel.unit.empty() && std::max(std::abs(a), std::abs(b)) > ExtremeFinder::k_at_pole;
  return is_at_pole && a != b ? k_unknown_error : difference(a, b);
}

void keep_larger(double& error, double other) { error = larger_error(error, other); }

// Returns true if values of this unit may jump at events. Positions do not; velocities jump at impacts.
bool may_jump(const Channel& channel) { return channel.unit != "m" && channel.unit != "rad"; }

// Compares a run with one finer run.
class Comparison {
public:
  /// The i-th sample of `run` belongs to sample i · `stride` of `fine`. `factor`: ratio of error to difference.
  Comparison(const System& system, const RunResult& run, const RunResult& fine, double factor, std::size_t stride = 1)
      : system_(system), run_(run), fine_(fine), match_(match_events(run.events, fine.events)), factor_(factor), stride_(stride) {}

  [[nodiscard]] const EventMatch& match() const { return match_; }

  /// Adds the error of each result, `factor` times its difference, to the estimate if it is larger than the one there.
  void add_to(GlobalErrorEstimate& estimate) const {
    const std::size_t ranges = std::min(run_.ranges.size(), fine_.ranges.size());
    for (std::size_t c = 0; c < ranges; ++c) add_range(c, estimate.channels[c]);
    add_curves(estimate.channels);
    add_events(estimate.event_times);
    keep_larger(estimate.dissipated, factor_ * difference(run_.statistics.dissipated, fine_.statistics.dissipated));
    keep_larger(estimate.work, factor_ * difference(run_.statistics.work, fine_.statistics.work));
  }

private:
  void add_range(std::size_t c, ChannelError& error) const {
    const ChannelRange &mine = run_.ranges[c], &fine = fine_.ranges[c];
    keep_larger(error.low, factor_ * difference(*mine.channel, mine.low.value, fine.low.value));
    keep_larger(error.high, factor_ * difference(*mine.channel, mine.high.value, fine.high.value));
    keep_larger(error.final, factor_ * difference(*mine.channel, mine.final, fine.final));
    keep_larger(error.t_low, factor_ * difference(mine.low.t, fine.low.t));
    keep_larger(error.t_high, factor_ * difference(mine.high.t, fine.high.t));
    keep_larger(error.first_above_one, factor_ * difference(mine.first_above_one, fine.first_above_one));
    if (mine.had_no_value != fine.had_no_value) error.low = error.high = k_unknown_error;
  }

  // Trajectories are compared row by row, because they may be on disk.
  void add_curves(std::vector<ChannelError>& errors) const {
    const Trajectory &mine = *run_.trajectory, &fine = *fine_.trajectory;
    const auto& channels = mine.channels();
    const RowPairs rows(mine, fine, stride_);
    const BetweenEvents between(match_, run_.events, fine_.events);
    std::vector<char> jumps(channels.size());
    std::transform(channels.begin(), channels.end(), jumps.begin(), [](const Channel* channel) { return may_jump(*channel); });
    std::vector<double> worst(channels.size(), 0.0);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::span<const double> a = mine.row(row), b = fine.row(rows.theirs(row));
      const bool is_jump = between.holds(a[0]);
      for (std::size_t c = 0; c < channels.size(); ++c)
        if (!jumps[c] || !is_jump) worst[c] = larger_error(worst[c], difference(*channels[c], a[c + 1], b[c + 1]));
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      ChannelError& error = errors[static_cast<std::size_t>(channels[c] - system_.channels.data())];
      keep_larger(error.curve, factor_ * worst[c]);
      error.is_sampled = true;
    }
  }

  void add_events(std::vector<double>& times) const {
    for (const EventPair& pair : match_.pairs) {
      const Event &mine = run_.events[pair.mine], &theirs = fine_.events[pair.reference];
      keep_larger(times[pair.mine], factor_ * difference(mine.t, theirs.t) + theirs.located_within);
    }
    for (const std::size_t alone : match_.only_mine) times[alone] = k_unknown_error;
  }

  const System& system_;
  const RunResult &run_, &fine_;
  EventMatch match_;
  double factor_;
  std::size_t stride_;
};

double spread_of(const ChannelRange& range) { return range.high.value - range.low.value; }

// Values common to all channels with the same unit.
struct Kind {
  double range = 0.0, largest = 0.0; ///< largest range, largest value
  double scale = 0.0;                ///< size of forces or motions that the model could have; its rounding errors remain if nothing moves
  double typical_error = 0.0;        ///< median error of extremes over their ranges
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::map<std::string, Kind> kinds_of(const std::vector<ChannelRange>& ranges, const std::vector<ChannelError>& errors) {
  std::map<std::string, Kind> kinds;
  std::map<std::string, std::vector<double>> relative;
  for (std::size_t c = 0; c < ranges.size(); ++c) {
    const double spread = spread_of(ranges[c]), error = std::max(errors[c].low, errors[c].high);
    if (!std::isfinite(spread)) continue;
    Kind& kind = kinds[ranges[c].channel->unit];
    kind.range = std::max(kind.range, spread);
    kind.largest = std::max({kind.largest, std::abs(ranges[c].low.value), std::abs(ranges[c].high.value)});
    if (spread > 0.0 && std::isfinite(error)) relative[ranges[c].channel->unit].push_back(error / spread);
  }
  for (auto& [unit, kind] : kinds) kind.typical_error = median(std::move(relative[unit]));
  return kinds;
}

// Sets the scales of all units, as in extreme_scales.cpp: acceleration a = F/m with the largest force F, velocity √(a L) with the length L
// of the model. For angular accelerations, (g + acceleration of the centre)/radius of gyration is a scale, too.
void set_scales(const System& system, const RunResult& run, std::map<std::string, Kind>& kinds) {
  const auto largest = [&](const char* unit) {
    const auto found = kinds.find(unit);
    return found == kinds.end() ? 0.0 : found->second.largest;
  };
  double mass = 0.0, turned = 0.0;
  std::map<std::string, double> acceleration; // of each body by name, m/s²
  for (const ChannelRange& range : run.ranges)
    if (const std::string& name = range.channel->name; range.channel->unit == "m/s^2" && std::isfinite(range.largest().value))
      acceleration[name.substr(0, name.rfind('.'))] += std::abs(range.largest().value);
  for (const BodyData& body : system.bodies) {
    mass += body.mass;
    if (body.mass > 0.0 && body.inertia > 0.0)
      turned = std::max(turned, (system.gravity.norm() + acceleration[body.name]) / std::sqrt(body.inertia / body.mass));
  }
  const double length = largest("m") > 0.0 ? largest("m") : 1.0;
  const double force = std::max(largest("N"), mass * system.gravity.norm()), a = mass > 0.0 ? force / mass : 0.0, v = std::sqrt(a * length);
  const std::pair<const char*, double> scales[] = {
      {"m/s", v},   {"rad/s", v / length},   {"m/s^2", a},     {"rad/s^2", std::max(turned, a / length)},
      {"N", force}, {"N m", force * length}, {"W", force * v}, {"J", force * length}};
  for (const auto& [unit, scale] : scales)
    if (const auto found = kinds.find(unit); found != kinds.end()) found->second.scale = scale;
}

bool is_exact(const ChannelRange& a, const ChannelRange& b) {
  return a.low.value == a.high.value && b.low.value == a.low.value && b.high.value == a.high.value;
}

bool diverges(const ChannelRange& range, const Extreme& extreme, double error) {
  const double size = std::abs(extreme.value);
  return !(error <= k_disagreed * size) && size > k_grown * std::max(std::abs(range.first), std::abs(range.final));
}

// Returns false for a formula whose extremes could not be bounded to the resolution, so that both runs may have missed the same extreme.
bool is_located(const ChannelRange& range, const Kind& kind) {
  const double size = std::max({kind.range, kind.largest, range.channel->unit.empty() ? 1.0 : 0.0});
  return !formula_of(*range.channel) || range.resolution <= ExtremeFinder::k_resolution * size;
}

// Adds those errors to the estimate that the finest run shares with the run.
void add_floors(const System& system, const RunResult& run, GlobalErrorEstimate& estimate) {
  const SimulationOptions& options = estimate.finer.back();
  const IntegratorSettings& settings = options.settings;
  const bool has_located_events = locates_events(options);
  const double tolerance = is_adaptive(system, options.integrator) ? settings.tolerance : settings.projection_tolerance;
  const double end = run.final_state.t;
  const double time = (tolerance + k_least_error) * end + (has_located_events ? 0.0 : settings.step);
  std::map<std::string, Kind> kinds = kinds_of(run.ranges, estimate.channels);
  set_scales(system, run, kinds);
  for (std::size_t c = 0; c < run.ranges.size(); ++c) {
    const ChannelRange& range = run.ranges[c];
    const Kind& kind = kinds[range.channel->unit];
    if (is_located(range, kind) && is_exact(range, estimate.finest.ranges[c])) continue;
    ChannelError& error = estimate.channels[c];
    const double spread = spread_of(range), of_kind = tolerance * kind.range + k_least_error * std::max(kind.largest, kind.scale);
    // Dimensionless numbers have no size in common: a margin near its pole says nothing about a share, nor about its own least value.
    const auto floor_at = [&](double value) {
      if (!range.channel->unit.empty()) return of_kind;
      const double size = std::isfinite(value) ? std::max(1.0, std::abs(value)) : 1.0;
      return tolerance * std::min(spread, size) + k_least_error * size;
    };
    // In time stepping the position of an impact within a step is random, and a single extreme may agree by chance. The median error of all
    // channels with the same unit is therefore the least estimate.
    const double least = !has_located_events && std::isfinite(spread) ? kind.typical_error * spread : 0.0;
    const double resolution = std::isinf(range.resolution) ? k_unknown_error : range.resolution;
    error.low = larger_error(larger_error(error.low, least), range.unsure_low) + floor_at(range.low.value) + resolution;
    error.high = larger_error(larger_error(error.high, least), range.unsure_high) + floor_at(range.high.value) + resolution;
    if (range.is_low_singular && diverges(range, range.low, error.low)) error.low = k_unknown_error;
    if (range.is_high_singular && diverges(range, range.high, error.high)) error.high = k_unknown_error;
    error.final += floor_at(range.final);
    error.curve += floor_at(range.largest().value);
    error.t_low += time;
    error.t_high += time;
    error.first_above_one += time;
  }
  for (std::size_t i = 0; i < run.events.size(); ++i)
    if (!run.events[i].is_at_start()) estimate.event_times[i] += time + run.events[i].located_within;
  const RunStatistics& s = run.statistics;
  if (s.dissipated != 0.0) estimate.dissipated += tolerance * s.energy_scale + k_least_error * std::abs(s.dissipated);
  if (s.work != 0.0) estimate.work += tolerance * s.energy_scale + k_least_error * std::abs(s.work);
}

// Sets all errors to unknown, because no finer run exists. Constants and events at t = 0 stay known.
void forget(const RunResult& run, GlobalErrorEstimate& estimate) {
  constexpr double unknown = k_unknown_error;
  for (std::size_t c = 0; c < run.ranges.size(); ++c)
    if (!is_exact(run.ranges[c], estimate.finest.ranges[c]))
      estimate.channels[c] = {unknown, unknown, unknown, unknown, unknown, unknown, unknown, true};
  for (std::size_t i = 0; i < run.events.size(); ++i)
    if (!run.events[i].is_at_start()) estimate.event_times[i] = unknown;
  if (run.statistics.dissipated != 0.0) estimate.dissipated = unknown;
  if (run.statistics.work != 0.0) estimate.work = unknown;
  estimate.error.worst.fill({unknown, "", 0.0});
  estimate.reason_unknown = "no finer run took shorter steps, so the error cannot be estimated";
}

// Sets the error of event times to unknown if an event has no partner.
void note_unmatched(GlobalErrorEstimate& estimate, const RunResult& run, const EventFilter& is_counted) {
  if (estimate.error.unmatched_events == 0) return;
  WorstError& worst = estimate.error.worst[static_cast<std::size_t>(ErrorKind::event_time)];
  worst = {k_unknown_error, "", 0.0};
  for (std::size_t i = run.events.size(); i-- > 0;)
    if (std::isnan(estimate.event_times[i]) && (!is_counted || is_counted(run.events[i])))
      worst = {k_unknown_error, "'" + run.events[i].element + "' " + run.events[i].words(), run.events[i].t};
}

void keep_worst(RunDifference& worst, const RunDifference& other, double factor) {
  for (std::size_t k = 0; k < k_error_kinds; ++k) {
    const double value = factor * other.worst[k].value;
    if (std::isnan(worst.worst[k].value) || value <= worst.worst[k].value) continue;
    worst.worst[k] = other.worst[k];
    worst.worst[k].value = value;
  }
  worst.unmatched_events = std::max(worst.unmatched_events, other.unmatched_events);
  worst.compared_until = other.compared_until;
}

// --- errors by reference runs

// Adds the error of the reference, which is estimated from the coarser reference run. That run may have few samples and no extremes.
void add_own_errors(const System& system, const RunResult& run, const ReferenceRuns& pair, const EventMatch& match,
                    GlobalErrorEstimate& estimate) {
  GlobalErrorEstimate own;
  own.channels.resize(system.channels.size());
  own.event_times.resize(pair.coarse.events.size());
  const Comparison comparison(system, pair.coarse, pair.reference, pair.factor, pair.stride);
  comparison.add_to(own);
  std::vector<double> of_event(pair.reference.events.size(), k_unknown_error);
  for (const EventPair& same : comparison.match().pairs) of_event[same.reference] = own.event_times[same.mine];
  double time = 0.0; // largest error of the events that both runs have
  for (const EventPair& same : match.pairs) {
    estimate.event_times[same.mine] += of_event[same.reference];
    if (std::isfinite(of_event[same.reference])) time = std::max(time, of_event[same.reference]);
  }
  for (std::size_t c = 0; c < estimate.channels.size(); ++c) {
    ChannelError& error = estimate.channels[c];
    const ChannelError& o = own.channels[c];
    const bool has_range = c < run.ranges.size(); // some channels have samples but no extremes
    if (has_range && std::isfinite(run.ranges[c].low.value)) error.low += larger_error(o.low, o.curve);
    if (has_range && std::isfinite(run.ranges[c].high.value)) error.high += larger_error(o.high, o.curve);
    error.final += larger_error(o.final, o.curve);
    error.curve += o.curve;
    for (double* value : {&error.t_low, &error.t_high, &error.first_above_one}) *value += time;
  }
  estimate.dissipated += own.dissipated;
  estimate.work += own.work;
  for (std::size_t k = 0; k < k_error_kinds; ++k) estimate.error.worst[k].value += pair.own.worst[k].value;
}

std::string tolerances_of(const ReferenceRuns& pair) {
  return pair.options.integrator + " at tolerances of " + rounded_text(pair.coarse_options.settings.tolerance) + " and " +
         rounded_text(pair.options.settings.tolerance);
}

// Sets the errors of all results after t, where the two references diverge, to unknown. Earlier events and crossings of 1 keep their
// errors. Extremes cover the whole run and become unknown.
void forget_from(double t, const RunResult& run, const ReferenceRuns& pair, GlobalErrorEstimate& estimate) {
  const std::vector<ChannelError> channels = estimate.channels;
  const std::vector<double> times = estimate.event_times;
  forget(run, estimate);
  for (std::size_t c = 0; c < run.ranges.size(); ++c)
    if (const std::optional<double>& first = run.ranges[c].first_above_one; first && *first < t)
      estimate.channels[c].first_above_one = channels[c].first_above_one;
  for (std::size_t i = 0; i < run.events.size(); ++i)
    if (run.events[i].t < t) estimate.event_times[i] = times[i];
  estimate.reason_unknown = "two runs by " + tolerances_of(pair) + " part at t = " + rounded_text(t, 4) +
                            " s, so the motion from there on depends on the last digits and cannot be computed";
}

// Estimates the errors of `run` by reference runs. Returns false if there are no usable ones.
bool measure_by_references(const System& system, const State& initial, const SimulationOptions& options, const RunResult& run,
                           const EventFilter& is_counted, EvaluationBudget& budget, GlobalErrorEstimate& estimate) {
  const double parts = evaluation_cost(system, run.statistics) / static_cast<double>(std::max(run.statistics.evaluations, 1L));
  const double most = std::max(relative_cost_of_finer_runs(system, options) * static_cast<double>(run.statistics.evaluations),
                               k_little / std::max(parts, 1.0));
  std::optional<ReferenceRuns> pair = reference_runs(system, initial, options, run, is_counted, most, budget);
  if (!pair) return false;
  estimate.finer = {pair->coarse_options, pair->options};
  const Comparison comparison(system, run, pair->reference, k_safety);
  comparison.add_to(estimate);
  keep_worst(estimate.error, pair->of_run, k_safety);
  add_own_errors(system, run, *pair, comparison.match(), estimate);
  estimate.finest = std::move(pair->reference);
  add_floors(system, run, estimate);
  if (pair->parted_at) forget_from(*pair->parted_at, run, *pair, estimate);
  else estimate.references = tolerances_of(*pair);
  return true;
}

// --- errors by finer runs of the same method

void compare_with_finer_runs(const System& system, const State& initial, const SimulationOptions& options, const RunResult& run,
                             const EventFilter& is_counted, EvaluationBudget& budget, GlobalErrorEstimate& estimate) {
  estimate.finer = finer_options(system, options);
  bool has_storm = run.statistics.storms > 0, is_any_finer = false;
  for (SimulationOptions& finer : estimate.finer) {
    RunResult fine = budget.simulate(system, initial, finer);
    if (!takes_shorter_steps(fine.statistics, run.statistics) && finer.settings.step == options.settings.step) {
      finer.settings.max_step = k_finer_step * (run.final_state.t - initial.t) / static_cast<double>(std::max(run.statistics.steps, 1L));
      fine = budget.simulate(system, initial, finer);
    }
    has_storm = has_storm || fine.statistics.storms > 0;
    const double factor = factor_for(options, run.statistics, finer, fine.statistics, has_storm);
    if (!std::isnan(factor)) {
      is_any_finer = true;
      Comparison(system, run, fine, factor).add_to(estimate);
      keep_worst(estimate.error, compare_runs(system, run, fine, is_counted), factor);
    }
    estimate.finest = std::move(fine);
  }
  if (is_any_finer) add_floors(system, run, estimate);
  else forget(run, estimate);
}

} // namespace

double larger_error(double a, double b) { return std::isnan(a) || std::isnan(b) ? k_unknown_error : std::max(a, b); }

double ChannelError::largest() const {
  double worst = 0.0;
  for (const double error : {low, high, final, curve}) worst = larger_error(worst, error);
  return worst;
}

bool is_adaptive(const System& system, const std::string& integrator) {
  const Dynamics dynamics(system);
  IntegratorSettings settings;
  settings.step = 1e-3; // any value, since no step is made
  return make_integrator(integrator, dynamics, settings)->is_adaptive();
}

bool is_measured_by_references(const System& system, const std::string& integrator) {
  return !method(integrator).is_time_stepping && !is_adaptive(system, integrator);
}

std::vector<SimulationOptions> finer_options(const System& system, const SimulationOptions& options) {
  SimulationOptions finer = options;
  finer.settings.division = k_division * options.settings.division;
  finer.storm_step = k_finer_step * options.storm_step;
  if (is_adaptive(system, options.integrator)) {
    finer.settings.tolerance = std::max(k_least_tolerance, k_finer_tolerance * options.settings.tolerance);
    return {finer};
  }
  finer.settings.step = k_finer_step * options.settings.step;
  SimulationOptions finest = finer;
  finest.settings.step *= k_finer_step;
  finest.settings.division *= k_division;
  return {finer, finest};
}

double relative_cost_of_finer_runs(const System& system, const SimulationOptions& options) {
  if (is_adaptive(system, options.integrator)) return k_finer_cost;
  double times = 0.0;
  for (const SimulationOptions& finer : finer_options(system, options)) times += options.settings.step / finer.settings.step;
  return times;
}

double evaluation_cost(const System& system, const RunStatistics& run) {
  return static_cast<double>(run.evaluations) * static_cast<double>(system.bodies.size() + system.element_names.size());
}

GlobalErrorEstimate estimate_global_error(const System& system, const State& initial, const SimulationOptions& options,
                                          const RunResult& run, const EventFilter& is_counted, double most_evaluations) {
  GlobalErrorEstimate estimate;
  estimate.channels.resize(system.channels.size());
  estimate.event_times.resize(run.events.size());
  EvaluationBudget budget(most_evaluations);
  const bool has_references = is_measured_by_references(system, options.integrator) && run.statistics.storms == 0 &&
                              measure_by_references(system, initial, options, run, is_counted, budget, estimate);
  if (!has_references) compare_with_finer_runs(system, initial, options, run, is_counted, budget, estimate);
  estimate.cost = budget.spent();
  note_unmatched(estimate, run, is_counted);
  estimate.finest.trajectory.reset();
  return estimate;
}

} // namespace steplap
