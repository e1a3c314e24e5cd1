#include "tests/scales/alike.h"

#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/trust/judge.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap::testing {

namespace {

// `size`: what a channel's own values are measured against at least.
void compare(Difference& d, const ChannelRange& own, const ChannelRange& other, double factor, double size) {
  const double pairs[][2] = {{own.low.value, other.low.value}, {own.high.value, other.high.value}, {own.final, other.final}};
  for (const auto& pair : pairs)
    if (std::isfinite(pair[0])) size = std::max(size, std::abs(pair[0]));
  for (const auto& pair : pairs) {
    const double a = pair[0], b = pair[1] / factor;
    if (a == b || (std::isnan(a) && std::isnan(b))) continue;
    const double difference =
        size > 0.0 && std::isfinite(a) && std::isfinite(b) ? std::abs(a - b) / size : std::numeric_limits<double>::infinity();
    if (difference <= d.value) continue;
    d.value = difference;
    d.channel = own.channel->name;
  }
}

} // namespace

Original::Original(const std::string& file, double longest, const std::string& integrator)
    : model_(read_model(file, transformer_catalog())) {
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
  // What bodies at rest still do is rounding, and so is a force of those: a thousandth of what there is in a scene of this length,
  // rate and mass is measured against itself, less against that.
  constexpr double k_least_share = 1e-3;
  const SceneUnits& units = own_.system->scale;
  double mass = 0.0;
  for (const BodyData& body : own_.system->bodies) mass = std::max(mass, body.mass);
  const Scaling scene{units.length, units.time(), mass};
  for (std::size_t c = 0; c < own_.result.ranges.size(); ++c) {
    const std::string& unit = own_.result.ranges[c].channel->unit;
    compare(d, own_.result.ranges[c], other.result.ranges[c], by.factor(unit), k_least_share * scene.factor(unit));
  }
  return d;
}

} // namespace steplap::testing
