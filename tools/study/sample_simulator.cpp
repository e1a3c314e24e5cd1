#include "tools/study/sample_simulator.h"

#include "mbd/base/event_kind.h"
#include "mbd/base/name_pattern.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "mbd/rest/start.h"
#include "mbd/run/load_cases.h"
#include "mbd/run/report.h"
#include "mbd/system/instance.h"
#include "mbd/trust/judge.h"
#include "tools/study/history.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace steplap::study {

/// Extremes of a channel that responses need. If a response takes the extreme over several channels, each channel's extreme matters only if
/// it exceeds those of the others; such a group is a "race".
struct RequestedExtremes {
  bool low = false, high = false;
  double low_below = -std::numeric_limits<double>::infinity();
  std::vector<std::size_t> low_races, high_races; ///< indices of the races in which the channel's minimum and maximum take part
  void add(const RequestedExtremes& more) {
    low = low || more.low;
    high = high || more.high;
    low_below = std::max(low_below, more.low_below);
    low_races.insert(low_races.end(), more.low_races.begin(), more.low_races.end());
    high_races.insert(high_races.end(), more.high_races.begin(), more.high_races.end());
  }
};

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

// Returns the extreme over all channels that match the response.
Extreme extreme_of(const Response& r, const std::vector<ChannelRange>& ranges) {
  const bool is_low = r.measure == Measure::lowest, is_largest = r.measure == Measure::largest_magnitude;
  Extreme best;
  for (const ChannelRange& range : ranges) {
    if (!matches_pattern(range.channel->name, r.channel)) continue;
    Extreme e = is_low ? range.low : is_largest ? range.largest() : range.high;
    if (is_largest) e.value = std::abs(e.value);
    if (std::isnan(e.value)) return {};
    if (std::isnan(best.value) || (is_low ? e.value < best.value : e.value > best.value)) best = e;
  }
  return best;
}

// Returns true if the extreme occurs near a singular position of joints, where reactions grow as 1/distance. Its value depends on the
// steps, which error estimates of one run do not show.
bool is_singular(const Response& r, const std::vector<ChannelRange>& ranges) {
  const Extreme extreme = extreme_of(r, ranges);
  return std::any_of(ranges.begin(), ranges.end(), [&](const ChannelRange& range) {
    return matches_pattern(range.channel->name, r.channel) &&
           ((range.is_low_singular && std::abs(range.low.value) == std::abs(extreme.value)) ||
            (range.is_high_singular && std::abs(range.high.value) == std::abs(extreme.value)));
  });
}

const ChannelRange* range_of(const Response& r, const std::vector<ChannelRange>& ranges) {
  for (const ChannelRange& range : ranges)
    if (matches_pattern(range.channel->name, r.channel)) return &range;
  return nullptr;
}

// Computes the mean or the path of a channel from the output samples.
double along(const Response& r, const Trajectory& trajectory) {
  const auto& channels = trajectory.channels();
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel* c) { return matches_pattern(c->name, r.channel); });
  if (found == channels.end() || trajectory.size() < 2) return k_nan;
  const auto column = static_cast<std::size_t>(found - channels.begin());
  double sum = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double before = trajectory.value(i - 1, column), after = trajectory.value(i, column);
    sum += r.measure == Measure::path ? std::abs(after - before) : 0.5 * (before + after) * (trajectory.time(i) - trajectory.time(i - 1));
  }
  return r.measure == Measure::path ? sum : sum / (trajectory.time(trajectory.size() - 1) - trajectory.time(0));
}

double of_events(const Response& r, const std::vector<Event>& events) {
  const EventKinds kinds = event_kinds_matching(r.event);
  long count = 0;
  for (const Event& event : events) {
    if (!kinds.test(static_cast<std::size_t>(event.kind))) continue;
    if (!r.element.empty() && !matches_pattern(event.element, r.element)) continue;
    if (r.measure == Measure::first_event) return event.t;
    ++count;
  }
  return r.measure == Measure::event_count ? static_cast<double>(count) : r.otherwise.value_or(std::numeric_limits<double>::infinity());
}

// Relative rounding error of results of a run. For example, margins of sliding joints differ from 1 by 2e-12.
constexpr double k_rounding = 1e-10;

// Returns true if the response is the lowest margin of joints and one of them slid. The margin was then below 1, but the value is unknown,
// because friction limits the load.
bool has_slipped(const Response& r, const std::vector<Event>& events) {
  return r.measure == Measure::lowest && std::any_of(events.begin(), events.end(), [&](const Event& event) {
           return is_slip(event.kind) && matches_pattern(event.element + ".margin", r.channel);
         });
}
constexpr double k_below = 10.0 * k_rounding;

// Returns true if the values of a response have rounding errors; counts, verdicts and codes are exact.
bool has_rounding(const Response& r, const System& system) {
  if (!r.expression.empty() || r.measure == Measure::event_count || r.measure == Measure::verdict) return false;
  const std::vector<const Channel*> channels = channels_of(r, system);
  return r.takes_time || std::any_of(channels.begin(), channels.end(), [](const Channel* c) { return c->codes.empty(); }) ||
         channels.empty();
}

double value_of(const Response& r, const RunResult& result, const Judgement& judgement, double reserve) {
  if (r.measure == Measure::verdict) return static_cast<double>(judgement.verdict);
  if (r.measure == Measure::reserve) return reserve;
  if (r.measure == Measure::event_count || r.measure == Measure::first_event) return of_events(r, result.events);
  if (needs_samples(r.measure)) return along(r, *result.trajectory);
  if (r.measure == Measure::final_value || r.measure == Measure::initial_value) {
    const ChannelRange* range = range_of(r, result.ranges);
    return !range ? k_nan : r.measure == Measure::final_value ? range->final : range->first;
  }
  const Extreme e = extreme_of(r, result.ranges);
  if (std::isnan(e.value)) return e.value;
  return r.takes_time ? e.t : has_slipped(r, result.events) ? std::min(e.value, 1.0 - k_below) : e.value;
}

/// Extremes so far over all channels of one race.
struct RunningExtremes {
  double lowest = std::numeric_limits<double>::infinity(), highest = -std::numeric_limits<double>::infinity();
};

using RunningExtremesList = std::vector<std::shared_ptr<RunningExtremes>>; // shared between the channels of a race

// Restricts the bounds of an expensive channel, so that it is evaluated only where it may reach a required extreme. In a race these are
// values beyond the extreme of all channels so far. The bounds are widened by the channel's change per step.
class RequestedBounds {
public:
  RequestedBounds(std::function<ValueBounds(const Snapshot&)> bounds, const RequestedExtremes& ends, const RunningExtremesList& races)
      : bounds_(std::move(bounds)), ends_(ends) {
    for (const std::size_t race : ends.low_races) low_races_.push_back(races[race]);
    for (const std::size_t race : ends.high_races) high_races_.push_back(races[race]);
  }

  ValueBounds operator()(const Snapshot& s) {
    constexpr double k_never = 1e300; // larger than any value
    const ValueBounds b = bounds_(s);
    if (s.t >= t_) { // not for evaluations within a step
      reach_ = {widened(reach_.low, b.low - last_.low), widened(reach_.high, b.high - last_.high)};
      last_ = b;
      t_ = s.t;
    }
    const double down = b.low - reach_.low, up = b.high + reach_.high;
    double low_below = ends_.low_below, high_above = std::numeric_limits<double>::infinity();
    for (const auto& race : low_races_) low_below = std::max(low_below, race->lowest);
    for (const auto& race : high_races_) high_above = std::min(high_above, race->highest);
    return {ends_.low || !(down > low_below) ? b.low : k_never, ends_.high || !(up < high_above) ? b.high : -k_never};
  }

private:
  // Returns the allowance for a change of a bound within a step. It is at least half the previous one, because a bound is nearly constant
  // near an extremum.
  static double widened(double reach, double change) {
    return std::isfinite(change) ? std::max(std::abs(change), 0.5 * reach) : 0.5 * reach;
  }

  std::function<ValueBounds(const Snapshot&)> bounds_;
  RequestedExtremes ends_;
  RunningExtremesList low_races_, high_races_;
  ValueBounds last_, reach_;
  double t_ = -std::numeric_limits<double>::infinity();
};

void leave_out_others(Channel& channel, const RequestedExtremes& ends, const RunningExtremesList& races) {
  if (channel.bounds && !(ends.high && ends.low)) channel.bounds = RequestedBounds(std::move(channel.bounds), ends, races);
  const auto note = [&](const std::vector<std::size_t>& of, const auto& noted) {
    for (const std::size_t race : of)
      channel.value = [value = std::move(channel.value), noted, own = races[race]](const Snapshot& s) { return noted(*own, value(s)); };
  };
  note(ends.low_races, [](RunningExtremes& race, double value) { return race.lowest = std::min(race.lowest, value), value; });
  note(ends.high_races, [](RunningExtremes& race, double value) { return race.highest = std::max(race.highest, value), value; });
}

// Returns the extremes of a channel that decide whether a run is trusted. A joint's margin matters only below 1.
RequestedExtremes ends_of_trust(const Channel* channel) {
  RequestedExtremes ends;
  if (channel && channel->role == ChannelRole::margin) ends.low_below = 1.0;
  else ends.low = ends.high = true;
  return ends;
}

void worsen(Outcome& outcome, SampleStatus status, const std::string& reason) {
  if (outcome.status != SampleStatus::ok) return; // only the first reason is kept
  outcome.status = status;
  outcome.reason = reason;
}

} // namespace

const char* name_of(SampleStatus status) {
  static constexpr const char* k_names[] = {"ok", "stopped", "untrusted", "gave up", "impossible", "not a number", "undecided"};
  return k_names[static_cast<int>(status)];
}

Model model_with(const LoadedStudy& loaded, const StudyModel& model, const double* values) {
  Model changed = model.given;
  for (std::size_t i = 0; i < loaded.study.variables.size(); ++i) {
    const Variable& v = loaded.study.variables[i];
    if (!is_set_in(v, model)) continue;
    for (const std::string& path : v.paths) set_value(changed, path, v.is_factor ? values[i] * number_of(model.given, path) : values[i]);
  }
  const std::size_t variant = loaded.variants.empty() ? 0 : static_cast<std::size_t>(values[loaded.study.variables.size() - 1]);
  if (variant > 0) loaded.variants[variant - 1].apply(changed);
  return changed;
}

// Data shared by all runs of a model. Only the extremes that responses need, and those that decide whether a run is trusted, are computed;
// all extremes would take 25 % of the time of a run.
struct SampleSimulator::SharedRunData {
  /// A path of the model that is set to `factor` times variable number `variable`.
  struct Setting {
    std::size_t variable;
    double factor;
  };
  const StudyModel& model;
  bool is_judged = false;                            ///< true if a response needs the judgement; criteria may use any channel
  bool needs_closed_verdict = false;                 ///< true if a response is undefined for an open verdict
  std::vector<std::string> channels;                 ///< names of the required channels
  std::map<std::string, RequestedExtremes> extremes; ///< required extremes by channel name
  std::size_t races = 0;
  std::vector<std::string> sampled; ///< name patterns of channels whose output samples are needed
  Sampling sampling;                ///< times at which output is needed, to be compared with measured records
  std::vector<Setting> settings;
  std::vector<double> numbers; ///< values to which the settings are set
  std::unique_ptr<Variants> variants;

  SharedRunData(const LoadedStudy& loaded, const StudyModel& which) : model(which), sampling(sampling_of(loaded.study, which)) {
    for (const Response& r : loaded.study.responses)
      if (r.model == model.name && r.expression.empty()) ask(r);
    for (const History& h : loaded.study.histories)
      if (h.model == model.name) channels.push_back(h.channel), sampled.push_back(h.channel);
    std::vector<std::string> paths;
    for (std::size_t i = 0; i < loaded.study.variables.size(); ++i) {
      const Variable& v = loaded.study.variables[i];
      if (!is_set_in(v, model)) continue;
      for (const std::string& path : v.paths) {
        settings.push_back({i, v.is_factor ? number_of(model.given, path) : 1.0});
        paths.push_back(path);
      }
    }
    for (const std::string& name : channels_of_trust(completed(model.given))) {
      channels.push_back(name);
      extremes[name].add(ends_of_trust(model.system->find_channel(name)));
    }
    numbers.resize(settings.size());
    variants = std::make_unique<Variants>(model.given, std::move(paths), wanted());
  }

  [[nodiscard]] const std::vector<std::string>* wanted() const { return is_judged ? nullptr : &channels; }

private:
  void ask(const Response& r) {
    is_judged = is_judged || study::is_judged(r.measure);
    needs_closed_verdict = needs_closed_verdict || r.measure == Measure::reserve;
    if (needs_samples(r.measure)) sampled.push_back(r.channel);
    const bool is_largest = r.measure == Measure::largest_magnitude;
    const bool is_low = r.measure == Measure::lowest, is_high = r.measure == Measure::highest;
    const auto asked = channels_of(r, *model.system);
    RequestedExtremes ends;
    ends.low = is_largest || (is_low && asked.size() < 2);
    ends.high = is_largest || (is_high && asked.size() < 2);
    if (asked.size() > 1 && is_low) ends.low_races.push_back(races++);
    if (asked.size() > 1 && is_high) ends.high_races.push_back(races++);
    for (const Channel* c : asked) {
      channels.push_back(c->name);
      if (is_extreme(r.measure)) extremes[c->name].add(ends);
    }
  }
};

SampleSimulator::SampleSimulator(const LoadedStudy& loaded) : loaded_(loaded) {
  std::vector<std::string> names = loaded.variable_names();
  const Study& study = loaded.study;
  for (std::size_t i = 0; i < study.responses.size(); ++i) {
    const Response& r = study.responses[i];
    if (!r.expression.empty()) expressions_.emplace_back(i, Expression(r.expression, names, r.where));
    names.push_back(r.name);
  }
  for (std::size_t i = 0; i < study.limit_states.size(); ++i) {
    const LimitState& l = study.limit_states[i];
    expressions_.emplace_back(study.responses.size() + i, Expression(l.expression, names, l.where));
    names.push_back(l.name);
  }
  values_.resize(names.size());
  for (std::size_t i = 0; i < study.responses.size(); ++i)
    for (const auto& model : loaded.models)
      if (study.responses[i].model == model->name && has_rounding(study.responses[i], *model->system)) measured_.push_back(i);
  for (const auto& model : loaded.models) runners_.push_back(std::make_unique<SharedRunData>(loaded, *model));
}

SampleSimulator::~SampleSimulator() = default;

// Writes the values of the measured channels at the measured times into `outcome.curve`.
void SampleSimulator::compare(const SharedRunData& runner, const RunResult& result, Outcome& outcome) const {
  std::size_t place = 0;
  for (const History& h : loaded_.study.histories) {
    if (h.model == runner.model.name) compare_times(h, runner.sampling, *result.trajectory, &outcome.curve[place]);
    place += h.t.size();
  }
}

void SampleSimulator::evaluate_responses(const SharedRunData& runner, const Judgement& judgement, const RunResult& result, double reserve,
                                         Outcome& outcome) {
  if (!result.stop_reason.empty()) worsen(outcome, SampleStatus::stopped, result.stop_reason);
  if (!judgement.distrust.empty()) worsen(outcome, SampleStatus::untrusted, judgement.distrust);
  const RunStatistics& s = result.statistics;
  if (s.energy_scale > 0.0) outcome.error = std::max(outcome.error, s.energy_residual / s.energy_scale);
  for (std::size_t i = 0; i < loaded_.study.responses.size(); ++i) {
    const Response& r = loaded_.study.responses[i];
    if (!r.expression.empty() || r.model != runner.model.name) continue;
    outcome.numbers[i] = value_of(r, result, judgement, reserve);
    if (is_extreme(r.measure) && is_singular(r, result.ranges))
      worsen(outcome, SampleStatus::untrusted,
             "'" + r.name + "' was found near a singular position of the joints, where reactions may be of any size");
  }
  if (!loaded_.study.histories.empty()) compare(runner, result, outcome);
}

void SampleSimulator::run_system(const SharedRunData& runner, const Model& whole, System& system, Outcome& outcome) {
  RunningExtremesList races;
  for (std::size_t i = 0; i < runner.races; ++i) races.push_back(std::make_shared<RunningExtremes>());
  for (Channel& c : system.channels) {
    const auto asked = runner.extremes.find(c.name);
    c.has_extremes = c.has_extremes && asked != runner.extremes.end();
    if (c.has_extremes) leave_out_others(c, asked->second, races);
  }
  SimulationOptions options = options_of(whole);
  options.channels = runner.sampled;
  options.has_extremes = true;
  if (runner.sampling.step > 0.0) options.output_step = runner.sampling.step;
  else if (runner.sampled.empty()) options.output_step = 0.0;
  Simulation simulation(system, start_of(whole, system), std::move(options));
  std::string failure;
  try {
    simulation.run();
  } catch (const NumericalFailure& error) {
    failure = error.what();
  }
  const RunResult result = std::move(simulation).result();
  outcome.evaluations += static_cast<double>(result.statistics.evaluations);
  if (failure.empty()) evaluate_responses(runner, judge(whole, system, result, ""), result, k_nan, outcome);
  else worsen(outcome, SampleStatus::gave_up, failure);
}

// Judges the run as the command line does, including findings and, if affordable, error estimates from finer runs.
void SampleSimulator::run_judged(const SharedRunData& runner, Model whole, std::unique_ptr<System> system, Outcome& outcome) {
  if (!whole.output.channels.empty())
    whole.output.channels.insert(whole.output.channels.end(), runner.sampled.begin(), runner.sampled.end());
  if (runner.sampling.step > 0.0) whole.output.step = runner.sampling.step;
  if (runner.model.load) keep_case_criteria(*runner.model.load, whole);
  const Report report = judged_run(load_completed(std::move(whole), std::move(system), runner.model.path));
  const RunResult& result = report.run.result;
  outcome.evaluations += static_cast<double>(result.statistics.evaluations);
  if (report.estimate.errors) outcome.evaluations += static_cast<double>(report.estimate.errors->cost.evaluations);
  if (report.run.failure) return worsen(outcome, SampleStatus::gave_up, report.run.failure->text);
  evaluate_responses(runner, report.judgement, result, reserve_of(report), outcome);
  if (runner.needs_closed_verdict && report.judgement.verdict == Verdict::open)
    worsen(outcome, SampleStatus::untrusted, "the verdict is open: " + overview_of(report).reason);
}

void SampleSimulator::run_model(SharedRunData& runner, const double* values, Outcome& outcome) {
  try {
    const std::size_t variant = loaded_.variants.empty() ? 0 : static_cast<std::size_t>(values[loaded_.study.variables.size() - 1]);
    std::unique_ptr<System> system;
    std::optional<Model> changed; // used only if a variant changes the model
    if (variant == 0) {
      for (std::size_t i = 0; i < runner.settings.size(); ++i)
        runner.numbers[i] = runner.settings[i].factor * values[runner.settings[i].variable];
      system = runner.variants->make(runner.numbers);
      if (runner.is_judged) changed = runner.variants->model();
    } else {
      changed = completed(model_with(loaded_, runner.model, values));
      system = compile(*changed, runner.wanted());
    }
    if (runner.is_judged) run_judged(runner, std::move(*changed), std::move(system), outcome);
    else run_system(runner, changed ? *changed : runner.variants->model(), *system, outcome);
  } catch (const NumericalFailure& error) {
    worsen(outcome, SampleStatus::gave_up, error.what());
  } catch (const ModelError& error) {
    worsen(outcome, SampleStatus::impossible, error.diagnostics().empty() ? error.what() : error.diagnostics().front().message);
  } catch (const std::exception& error) {
    worsen(outcome, SampleStatus::gave_up, std::string("internal error: ") + error.what());
  }
}

bool SampleSimulator::is_derived(const std::vector<double>& values, const Outcome& outcome) {
  std::vector<double> numbers = outcome.numbers;
  (void)derive(values.data(), numbers);
  const auto is_same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  bool is_whole = true;
  for (std::size_t i = loaded_.study.responses.size(); i < outcome.numbers.size(); ++i)
    is_whole = is_whole && !std::isnan(outcome.numbers[i]);
  return outcome.curve.size() == loaded_.curve_size() && (outcome.status != SampleStatus::ok || is_whole) &&
         std::equal(numbers.begin(), numbers.end(), outcome.numbers.begin(), is_same);
}

void SampleSimulator::evaluate_formulas(std::vector<double>& all) const {
  const std::size_t variables = loaded_.study.variables.size();
  for (const auto& [place, expression] : expressions_) all[variables + place] = expression(all.data());
}

// Returns the change of each number, summed over all measured responses, when these change by their rounding errors.
std::vector<double> SampleSimulator::rounding_of_formulas(const std::vector<double>& all) const {
  const std::size_t variables = loaded_.study.variables.size();
  std::vector<double> rounding(all.size() - variables, 0.0);
  for (const std::size_t i : measured_) {
    if (all[variables + i] == loaded_.study.responses[i].otherwise) continue; // time of an event that never happens: exact
    std::vector<double> largest(rounding.size(), 0.0);
    for (const double side : {-1.0, 1.0}) {
      std::vector<double> moved = all;
      moved[variables + i] *= 1.0 + side * k_rounding;
      evaluate_formulas(moved);
      for (std::size_t k = 0; k < largest.size(); ++k)
        largest[k] = std::max(largest[k], std::abs(moved[variables + k] - all[variables + k]));
    }
    for (std::size_t k = 0; k < rounding.size(); ++k) rounding[k] += largest[k];
  }
  return rounding;
}

// Computes the numbers defined by formulas. A limit state smaller in magnitude than its rounding error has no certain sign and is set to
// zero. This happens at borders, and on whole intervals if sliding friction keeps a number constant, for example its utilisation at 1. A
// zero without rounding error, such as a number of slips, is exact. Returns the index of the first limit state without sign, except those
// whose zeros the study searches; −1 if there is none.
int SampleSimulator::derive(const double* values, std::vector<double>& numbers) {
  const std::size_t variables = loaded_.study.variables.size(), responses = loaded_.study.responses.size();
  std::copy(values, values + variables, values_.begin());
  std::copy(numbers.begin(), numbers.end(), values_.begin() + static_cast<long>(variables));
  evaluate_formulas(values_);
  std::copy(values_.begin() + static_cast<long>(variables), values_.end(), numbers.begin());
  const std::vector<double> rounding = rounding_of_formulas(values_);
  int undecided = -1;
  for (std::size_t i = responses; i < numbers.size(); ++i) {
    if (!(rounding[i] > 0.0 && std::abs(numbers[i]) <= rounding[i])) continue;
    numbers[i] = 0.0;
    if (undecided < 0 && !loaded_.study.limit_states[i - responses].is_border) undecided = static_cast<int>(i);
  }
  return undecided;
}

void SampleSimulator::run(const double* values, Outcome& outcome) {
  const std::size_t numbers = loaded_.number_count();
  outcome.status = SampleStatus::ok;
  outcome.reason.clear();
  outcome.numbers.assign(numbers, k_nan);
  outcome.curve.assign(loaded_.curve_size(), k_nan);
  outcome.error = outcome.evaluations = outcome.cpu_seconds = 0.0;
  const bool has_models = !runners_.empty();
  const double begin = has_models ? thread_cpu_seconds() : 0.0;
  for (const auto& runner : runners_) run_model(*runner, values, outcome);
  const int undecided = derive(values, outcome.numbers);
  for (std::size_t i = loaded_.study.responses.size(); i < numbers; ++i)
    if (std::isnan(outcome.numbers[i]))
      worsen(outcome, SampleStatus::not_a_number, "limit state '" + loaded_.number_names()[i] + "' has no value");
  if (undecided >= 0)
    worsen(outcome, SampleStatus::undecided,
           "limit state '" + loaded_.number_names()[static_cast<std::size_t>(undecided)] +
               "' is zero to the rounding of the run: friction that slides keeps its share of 1. Ask for its event, or monitor the joint");
  if (has_models) outcome.cpu_seconds = thread_cpu_seconds() - begin;
}

} // namespace steplap::study
