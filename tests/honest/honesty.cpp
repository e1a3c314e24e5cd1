#include "tests/honest/honesty.h"

#include "mbd/io/reader.h"
#include "mbd/model/validate.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/trust/event_match.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace steplap::testing {

namespace {

constexpr double k_true_tolerance = 1e-12;
constexpr double k_rounding = 1e-13;
constexpr double k_no_length = 1e-9; // of a run

SimulationOptions with(SimulationOptions options, const std::string& integrator, double setting) {
  options.integrator = integrator;
  (has_fixed_step(integrator) ? options.settings.step : options.settings.tolerance) = setting;
  return options;
}

void look_at(Honesty& h, const std::string& where, double value, double truth, double truth_known_to, double estimate, double range) {
  ++h.count;
  if (std::isnan(estimate)) {
    ++h.unknown;
    return;
  }
  if (value == truth || (std::isnan(value) && std::isnan(truth)) || !std::isfinite(truth_known_to)) return;
  const double error = std::abs(value - truth) - truth_known_to;
  if (error <= 0.0) return;
  const double ratio = estimate > 0.0 ? error / estimate : std::numeric_limits<double>::infinity();
  h.tightness.push_back(1.0 / ratio);
  if (ratio > 1.0) ++h.too_small;
  if (std::isnan(error) || ratio > h.worst) {
    h.worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : ratio;
    h.where = where;
    h.error = error;
    h.estimate = estimate;
    h.most_range = range > 0.0 ? estimate / range : 0.0;
  }
}

// The instant at which a contact's force passes to another foot is felt by nothing else, and known less well. Nor is a slip of no
// length, by chance on the bound.
bool is_felt_by_others(const std::vector<Event>& events, const Event& event, double end) {
  const auto is_at_once = [&](const Event& other) {
    return &other != &event && other.element == event.element && std::abs(other.t - event.t) <= k_no_length * end;
  };
  return !is_kink(event.kind) && event.kind != EventKind::changes_foot && std::none_of(events.begin(), events.end(), is_at_once);
}

// Of channels in the same unit: beside it there is rounding.
std::map<std::string, double> largest_by_unit(const std::vector<ChannelRange>& ranges) {
  std::map<std::string, double> largest;
  for (const ChannelRange& t : ranges)
    for (const double value : {t.low.value, t.high.value, t.channel->unit.starts_with("rad") ? 1.0 : 0.0})
      if (std::isfinite(value)) largest[t.channel->unit] = std::max(largest[t.channel->unit], std::abs(value));
  return largest;
}

} // namespace

Truth::Truth(const std::string& file, double longest) {
  Model model = read_model(file, transformer_catalog());
  model.simulation.end = std::min(model.simulation.end, longest);
  model.output.step = std::min(model.output.step, model.simulation.end);
  system_ = compile(model);
  initial_ = assembled_start(*system_, assemble(model, *system_));
  if (model.simulation.initial == "equilibrium") {
    State still = initial_;
    std::fill(still.v.begin(), still.v.end(), 0.0);
    still = find_equilibrium(*system_, still).state;
    still.v = initial_.v;
    initial_ = still;
  }
  base_ = options_of(model);
  try {
    truth_ = simulate(*system_, initial_, with(base_, "dop853", k_true_tolerance));
    second_ = simulate(*system_, initial_, with(base_, "tsit5", k_true_tolerance));
  } catch (const NumericalFailure& failure) {
    failure_ = failure.what();
  }
}

Judged Truth::judged(const std::string& integrator, double setting) const {
  Judged judged;
  const SimulationOptions options = with(base_, integrator, setting);
  RunResult run;
  GlobalErrorEstimate estimate;
  try {
    run = simulate(*system_, initial_, options);
    estimate = estimate_global_error(*system_, initial_, options, run);
  } catch (const NumericalFailure& failure) {
    judged.failure = failure.what();
    return judged;
  }
  Honesty extremes{"extremes"}, times{"times of extremes"}, ends{"ends"}, curves{"curves"}, events{"event times"},
      energies{"dissipation, work"};
  const double end = run.final_state.t;
  const EventMatch match = match_events(run.events, truth_.events), own = match_events(truth_.events, second_.events);
  const std::map<std::string, double> largest = largest_by_unit(truth_.ranges);
  const auto rounding = [&](const Channel& channel) {
    return largest.contains(channel.unit) ? k_rounding * largest.at(channel.unit) : 0.0;
  };
  for (std::size_t c = 0; c < run.ranges.size(); ++c) {
    const ChannelRange &r = run.ranges[c], &t = truth_.ranges[c], &u = second_.ranges[c];
    const ChannelError& e = estimate.channels[c];
    const double range = t.high.value - t.low.value;
    const std::string& name = r.channel->name;
    const auto known = [&](double a, double b) { return rounding(*r.channel) + (a == b ? 0.0 : std::abs(a - b)); };
    // The truth, too, may have met an extreme where it did not know which way a slip goes.
    const double low_known = std::max({known(t.low.value, u.low.value), t.unsure_low, u.unsure_low}) + t.resolution;
    const double high_known = std::max({known(t.high.value, u.high.value), t.unsure_high, u.unsure_high}) + t.resolution;
    look_at(extremes, name + " low", r.low.value, t.low.value, low_known, e.low, range);
    look_at(extremes, name + " high", r.high.value, t.high.value, high_known, e.high, range);
    look_at(times, name + " low", r.low.t, t.low.t, std::abs(t.low.t - u.low.t), e.t_low, end);
    look_at(times, name + " high", r.high.t, t.high.t, std::abs(t.high.t - u.high.t), e.t_high, end);
    look_at(ends, name, r.final, t.final, known(t.final, u.final), e.final, range);
  }
  const BetweenEvents between(match, run.events, truth_.events), in_truth(own, truth_.events, second_.events);
  const auto& columns = run.trajectory->channels();
  const std::size_t rows = std::min({run.trajectory->size(), truth_.trajectory->size(), second_.trajectory->size()});
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const auto c = static_cast<std::size_t>(columns[column] - system_->channels.data());
    const bool jumps = columns[column]->unit != "m" && columns[column]->unit != "rad";
    double worst = 0.0, known = 0.0;
    for (std::size_t row = 0; row < rows; ++row) {
      const double t = run.trajectory->times()[row], a = run.trajectory->value(row, column), b = truth_.trajectory->value(row, column);
      if ((jumps && (between.holds(t) || in_truth.holds(t))) || !std::isfinite(a) || !std::isfinite(b)) continue;
      worst = std::max(worst, std::abs(a - b));
      known = std::max(known, std::abs(b - second_.trajectory->value(row, column)));
    }
    look_at(curves, columns[column]->name, worst, 0.0, known + rounding(*columns[column]), estimate.channels[c].curve,
            truth_.ranges[c].high.value - truth_.ranges[c].low.value);
  }
  std::vector<double> event_known(truth_.events.size(), k_unknown_error);
  for (const EventPair& pair : own.pairs) event_known[pair.mine] = std::abs(truth_.events[pair.mine].t - second_.events[pair.reference].t);
  const auto is_felt = [&](const Event& event) { return is_felt_by_others(run.events, event, end); };
  for (const EventPair& pair : match.pairs)
    if (is_felt(run.events[pair.mine]))
      look_at(events, run.events[pair.mine].element + " " + run.events[pair.mine].words(), run.events[pair.mine].t,
              truth_.events[pair.reference].t, event_known[pair.reference], estimate.event_times[pair.mine], end);
  // An event that one of the two truths has and the other not is not known to them.
  const std::vector<std::size_t> unknown_to_second = match_events(run.events, second_.events).only_mine;
  const auto is_known = [&](std::size_t event) { return std::ranges::count(unknown_to_second, event) > 0; };
  for (const std::size_t alone : match.only_mine)
    if (is_felt(run.events[alone]) && is_known(alone))
      look_at(events, "no such: " + run.events[alone].element + " " + run.events[alone].words(), 1.0, 0.0, 0.0,
              std::isnan(estimate.event_times[alone]) ? k_unknown_error : 1e-300, end);
  const RunStatistics &s = run.statistics, &t = truth_.statistics, &u = second_.statistics;
  look_at(energies, "dissipated", s.dissipated, t.dissipated, std::abs(t.dissipated - u.dissipated), estimate.dissipated, t.energy_scale);
  look_at(energies, "work", s.work, t.work, std::abs(t.work - u.work), estimate.work, t.energy_scale);
  return {.kinds = {extremes, times, ends, curves, events, energies}, .failure = {}};
}

} // namespace steplap::testing
