#include "tools/study/scene.h"

#include "mbd/analysis/start.h"
#include "mbd/base/event_kind.h"
#include "mbd/base/name_pattern.h"
#include "mbd/io/presentation.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "transformer/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap::study {

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

bool needs_samples(const Response& r) { return r.what == "mean" || r.what == "path"; }

// The outermost of all channels that match.
Extreme extreme_of(const Response& r, const std::vector<ChannelRange>& ranges) {
  const bool is_low = r.what.ends_with("lowest"), is_largest = r.what.ends_with("largest");
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

const ChannelRange* range_of(const Response& r, const std::vector<ChannelRange>& ranges) {
  for (const ChannelRange& range : ranges)
    if (matches_pattern(range.channel->name, r.channel)) return &range;
  return nullptr;
}

// Over the samples written: of curves between them nothing is known here.
double along(const Response& r, const Trajectory& trajectory) {
  const auto& channels = trajectory.channels();
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel* c) { return matches_pattern(c->name, r.channel); });
  if (found == channels.end() || trajectory.size() < 2) return k_nan;
  const auto column = static_cast<std::size_t>(found - channels.begin());
  double sum = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double before = trajectory.value(i - 1, column), after = trajectory.value(i, column);
    sum += r.what == "path" ? std::abs(after - before) : 0.5 * (before + after) * (trajectory.time(i) - trajectory.time(i - 1));
  }
  return r.what == "path" ? sum : sum / (trajectory.time(trajectory.size() - 1) - trajectory.time(0));
}

double of_events(const Response& r, const std::vector<Event>& events) {
  const EventKinds kinds = event_kinds_matching(r.event);
  long count = 0;
  for (const Event& event : events) {
    if (!kinds.test(static_cast<std::size_t>(event.kind))) continue;
    if (!r.element.empty() && !matches_pattern(event.element, r.element)) continue;
    if (r.what == "time_of_first") return event.t;
    ++count;
  }
  return r.what == "count" ? static_cast<double>(count) : r.otherwise.value_or(std::numeric_limits<double>::infinity());
}

double value_of(const Response& r, const RunResult& result, const Judgement& judgement) {
  if (r.what == "verdict") return static_cast<double>(judgement.so_far);
  if (r.what == "count" || r.what == "time_of_first") return of_events(r, result.events);
  if (needs_samples(r)) return along(r, *result.trajectory);
  if (r.what == "final" || r.what == "initial") {
    const ChannelRange* range = range_of(r, result.ranges);
    return !range ? k_nan : r.what == "final" ? range->final : range->first;
  }
  const Extreme e = extreme_of(r, result.ranges);
  return r.what.starts_with("time_of") && !std::isnan(e.value) ? e.t : e.value;
}

void worsen(Outcome& outcome, SampleStatus status, const std::string& reason) {
  if (outcome.status != SampleStatus::ok) return; // the first reason is told
  outcome.status = status;
  outcome.reason = reason;
}

} // namespace

const char* name_of(SampleStatus status) {
  static constexpr const char* k_names[] = {"ok", "stopped", "untrusted", "gave up", "impossible", "not a number"};
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

Scene::Scene(const LoadedStudy& loaded) : loaded_(loaded) {
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
}

void Scene::look(const StudyModel& model, const Model& whole, const System& system, const RunResult& result, Outcome& outcome) {
  const Judgement judgement = judge(whole, system, result, "");
  if (!result.stop_reason.empty()) worsen(outcome, SampleStatus::stopped, result.stop_reason);
  if (!judgement.distrust.empty()) worsen(outcome, SampleStatus::untrusted, judgement.distrust);
  const RunStatistics& s = result.statistics;
  if (s.energy_scale > 0.0) outcome.error = std::max(outcome.error, s.energy_residual / s.energy_scale);
  for (std::size_t i = 0; i < loaded_.study.responses.size(); ++i) {
    const Response& r = loaded_.study.responses[i];
    if (r.expression.empty() && r.model == model.name) outcome.numbers[i] = value_of(r, result, judgement);
  }
}

// A quarter of a run's time goes into extremes that nobody asks for. Joints that are judged keep theirs: whether a run is to
// be trusted hangs on them.
void Scene::look_only_where_asked(const StudyModel& model, System& system) const {
  std::vector<std::string> asked;
  for (const Response& r : loaded_.study.responses) {
    if (r.model != model.name || !r.expression.empty()) continue;
    if (r.what == "verdict") return; // of any channel that the model has a criterion for
    asked.push_back(r.channel);
  }
  for (std::size_t e = 0; e < system.element_names.size(); ++e)
    if (system.element_kinds[e] == "step_lap_joint") asked.push_back(system.element_names[e] + ".*");
  for (Channel& c : system.channels)
    c.has_extremes = c.has_extremes && std::any_of(asked.begin(), asked.end(), [&](const std::string& pattern) { return matches_pattern(c.name, pattern); });
}

void Scene::run_model(const StudyModel& model, const double* values, Outcome& outcome) {
  const auto& responses = loaded_.study.responses;
  try {
    Model whole = completed(model_with(loaded_, model, values));
    const std::unique_ptr<System> system = compile(whole);
    (void)check_presentation(whole, *system); // reads the limits of criteria
    look_only_where_asked(model, *system);
    SimulationOptions options = options_of(whole);
    options.channels = {"*"};
    options.has_extremes = true;
    std::vector<std::string> sampled;
    for (const Response& r : responses)
      if (r.model == model.name && needs_samples(r)) sampled.push_back(r.channel);
    if (sampled.empty()) options.output_step = 0.0;
    else options.channels = sampled;
    Simulation simulation(*system, start_of(whole, *system), std::move(options));
    std::string failure;
    try {
      simulation.run();
    } catch (const NumericalFailure& error) {
      failure = error.what();
    }
    const RunResult result = std::move(simulation).result();
    outcome.evaluations += static_cast<double>(result.statistics.evaluations);
    if (failure.empty()) look(model, whole, *system, result, outcome);
    else worsen(outcome, SampleStatus::gave_up, failure);
  } catch (const NumericalFailure& error) {
    worsen(outcome, SampleStatus::gave_up, error.what());
  } catch (const ModelError& error) {
    worsen(outcome, SampleStatus::impossible, error.diagnostics().empty() ? error.what() : error.diagnostics().front().message);
  } catch (const std::exception& error) {
    worsen(outcome, SampleStatus::gave_up, std::string("internal error: ") + error.what());
  }
}

void Scene::run(const double* values, Outcome& outcome) {
  const std::size_t variables = loaded_.study.variables.size(), numbers = loaded_.number_count();
  outcome.status = SampleStatus::ok;
  outcome.reason.clear();
  outcome.numbers.assign(numbers, k_nan);
  outcome.error = outcome.evaluations = outcome.cpu_seconds = 0.0;
  const bool has_models = !loaded_.models.empty();
  const double begin = has_models ? thread_cpu_seconds() : 0.0;
  for (const auto& model : loaded_.models) run_model(*model, values, outcome);
  std::copy(values, values + variables, values_.begin());
  std::copy(outcome.numbers.begin(), outcome.numbers.end(), values_.begin() + static_cast<long>(variables));
  for (const auto& [place, expression] : expressions_)
    values_[variables + place] = outcome.numbers[place] = expression(values_.data());
  for (std::size_t i = loaded_.study.responses.size(); i < numbers; ++i)
    if (std::isnan(outcome.numbers[i])) worsen(outcome, SampleStatus::not_a_number, "limit state '" + loaded_.number_names()[i] + "' has no value");
  if (has_models) outcome.cpu_seconds = thread_cpu_seconds() - begin;
}

} // namespace steplap::study
