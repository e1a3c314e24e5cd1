#include "tests/scales/alike.h"

#include "mbd/analysis/assembly.h"
#include "mbd/analysis/equilibrium.h"
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "transformer/catalog.h"
#include "transformer/verdict.h"

#include <algorithm>
#include <cmath>

namespace steplap::testing {

namespace {

void compare(Difference& d, const ChannelRange& own, const ChannelRange& other, double factor, double largest_in_unit) {
  const double pairs[][2] = {{own.low.value, other.low.value}, {own.high.value, other.high.value}, {own.final, other.final}};
  double size = 1e-9 * largest_in_unit; // what is smaller is rounding of the others
  for (const auto& pair : pairs)
    if (std::isfinite(pair[0])) size = std::max(size, std::abs(pair[0]));
  for (const auto& pair : pairs) {
    const double a = pair[0], b = pair[1] / factor;
    if (a == b || (std::isnan(a) && std::isnan(b))) continue;
    const double difference = size > 0.0 && std::isfinite(a) && std::isfinite(b) ? std::abs(a - b) / size : INFINITY;
    if (difference <= d.value) continue;
    d.value = difference;
    d.channel = own.channel->name;
  }
}

} // namespace

Original::Original(const std::string& file, double longest, const std::string& integrator) : model_(read_model(file, transformer_catalog())) {
  model_.simulation.end = std::min(model_.simulation.end, longest);
  model_.output.step = std::min(model_.output.step, model_.simulation.end);
  if (!integrator.empty()) model_.simulation.integrator = integrator;
  const auto system = compile(model_);
  (void)check_presentation(model_, *system);
  own_ = run(model_);
}

Original::Run Original::run(const Model& model) {
  Run run;
  try {
    run.system = compile(model);
    State initial = assembled_start(*run.system, assemble(model, *run.system));
    if (model.simulation.initial == "equilibrium") {
      const std::vector<double> v = initial.v;
      std::fill(initial.v.begin(), initial.v.end(), 0.0);
      initial = find_equilibrium(*run.system, initial).state;
      initial.v = v;
    }
    run.result = simulate(*run.system, initial, options_of(model));
    run.verdict = name_of(judge(model, *run.system, run.result, "").verdict);
  } catch (const std::exception& failure) {
    run.failure = failure.what();
  }
  return run;
}

Difference Original::difference(const Scaling& by) const {
  Difference d;
  if (!own_.system) return d;
  const Run other = run(scaled(model_, *own_.system, by));
  if (own_.failure.empty() != other.failure.empty()) d.failure = "'" + own_.failure + "' but '" + other.failure + "'";
  d.verdict[0] = own_.verdict;
  d.verdict[1] = other.verdict;
  if (!own_.failure.empty() || !other.failure.empty()) return d;
  const Run* const runs[] = {&own_, &other};
  for (int i = 0; i < 2; ++i) {
    d.steps[i] = runs[i]->result.statistics.steps;
    d.evaluations[i] = runs[i]->result.statistics.evaluations;
    d.events[i] = static_cast<long>(runs[i]->result.events.size());
  }
  const double end = model_.simulation.end;
  const auto &mine = own_.result.events, &its = other.result.events;
  for (std::size_t i = 0; i < std::max(mine.size(), its.size()) && d.first_event.empty(); ++i) {
    if (i >= mine.size()) d.first_event = "not in the model: " + its[i].element + " " + words_of(its[i].kind);
    else if (i >= its.size()) d.first_event = "not if scaled: " + mine[i].element + " " + words_of(mine[i].kind);
    else if (mine[i].element != its[i].element || mine[i].kind != its[i].kind)
      d.first_event = mine[i].element + " " + words_of(mine[i].kind) + " but " + its[i].element + " " + words_of(its[i].kind);
    else d.event_time = std::max(d.event_time, std::abs(mine[i].t - its[i].t / by.time) / end);
  }
  std::map<std::string, double> largest;
  for (const ChannelRange& range : own_.result.ranges)
    for (const double value : {range.low.value, range.high.value})
      if (std::isfinite(value)) largest[range.channel->unit] = std::max(largest[range.channel->unit], std::abs(value));
  for (std::size_t c = 0; c < own_.result.ranges.size(); ++c) {
    const ChannelRange& range = own_.result.ranges[c];
    compare(d, range, other.result.ranges[c], by.factor(range.channel->unit), largest[range.channel->unit]);
  }
  return d;
}

} // namespace steplap::testing
