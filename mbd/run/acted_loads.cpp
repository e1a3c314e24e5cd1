#include "mbd/run/acted_loads.h"

#include "mbd/base/name_pattern.h"
#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/signal_composites.h"
#include "mbd/model/signal_course.h"
#include "mbd/model/signal_network.h"
#include "mbd/run/acting_signals.h"
#include "mbd/run/late_formulas.h"
#include "mbd/run/limited_channels.h"
#include "mbd/run/range_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace steplap {

namespace {

constexpr double k_same_time = 1e-9; // times closer than this, relative to the duration of the run, are equal

Finding warning(const char* code, std::string text, const Location& where) { return {code, FindingLevel::warning, std::move(text), where}; }

// A signal, or one term of a sum of signals. Each term must act completely.
struct LoadPart {
  const SignalEntry* entry = nullptr;
  const Signal* signal = nullptr;
  SignalCourse course;
};

class Parts {
public:
  explicit Parts(const Model& model) : model_(model), network_(model) {}

  std::vector<LoadPart> of(const std::string& name) {
    std::vector<LoadPart> parts;
    add(name, parts);
    return parts;
  }

private:
  void add(const std::string& name, std::vector<LoadPart>& parts) {
    const auto entry =
        std::find_if(model_.signals.begin(), model_.signals.end(), [&](const SignalEntry& each) { return each.definition->name == name; });
    if (entry == model_.signals.end()) return;
    if (const auto summands = summands_of(*entry)) {
      for (const std::string& summand : *summands) add(summand, parts);
    } else if (const Signal* const signal = network_.build(name)) {
      parts.push_back({&*entry, signal, course_of(*signal)});
    }
  }

  const Model& model_;
  SignalNetwork network_;
};

// Decides whether bodies still move or accelerate at the end, compared with their largest velocities and accelerations of the run.
class Motions {
public:
  Motions(const LoadedModel& loaded, const RunResult& result) {
    const RangeIndex ranges(result.ranges);
    for (std::size_t i = 1; i < loaded.system->bodies.size(); ++i) {
      add(ranges, loaded.system->bodies[i].name, {"vx", "vy", "omega"}, rests_);
      add(ranges, loaded.system->bodies[i].name, {"ax", "ay", "alpha"}, is_even_);
    }
  }
  [[nodiscard]] bool rests() const { return rests_; }     ///< all velocities are zero
  [[nodiscard]] bool is_even() const { return is_even_; } ///< all accelerations are zero: bodies move uniformly

private:
  // Sets `holds` to false if a channel is still large at the end. A value of 0.001 of its maximum is the end of a decay; below 1e-6 SI
  // units a body at rest creeps numerically.
  static void add(const RangeIndex& ranges, const std::string& body, std::initializer_list<const char*> quantities, bool& holds) {
    constexpr double k_share = 1e-3, k_least = 1e-6;
    for (const char* const quantity : quantities) {
      const ChannelRange* const range = ranges.find(body + "." + quantity);
      if (!range) continue;
      const double largest = std::max(std::abs(range->low.value), std::abs(range->high.value));
      holds = holds && !(std::abs(range->final) > std::max(k_least, k_share * largest));
    }
  }
  bool rests_ = true, is_even_ = true;
};

std::string seconds(double t) { return rounded_text(t) + " s"; }

// Checks whether one signal has acted completely in one of its uses, and creates the finding if not.
class Judge {
public:
  // `growth` and `result` are null before a run. `has_course`: some load changes with time, which determines the length of the run.
  Judge(const LoadedModel& loaded, double end, const ReserveHistory* growth, const RunResult* result, bool has_course)
      : loaded_(loaded), model_(loaded.model), slack_(k_same_time * end), growth_(growth), result_(result), has_course_(has_course) {}

  std::optional<Finding> finding(const ActingSignal& use, const LoadPart& part) const {
    const SignalCourse& course = part.course;
    const bool is_steady = part.signal->is_constant();
    if (is_steady ? part.signal->value(0.0) == 0.0 : course.is_level()) return std::nullopt;
    if (is_steady && !use.is_named_at_start) return std::nullopt; // a constant such as "off" that only an action assigns
    if (use.spans.empty()) return never_begun(use, part.entry->definition->name, part.entry->definition->where);
    if (is_steady) return of_constant(use, "signal '" + part.entry->definition->name + "'", part.entry->definition->where);
    if (std::any_of(use.spans.begin(), use.spans.end(), [&](const SignalSpan& span) { return has_acted(span, part); }))
      return growing(use.spans.back(), part);
    double at_full_size = 0.0; // total time at full size, s, over all intervals in which the signal acts
    for (const SignalSpan& span : use.spans)
      at_full_size += std::max(0.0, std::min(span.to, course.ends) - std::max(span.from, course.full));
    if (course.period > 0.0 && at_full_size >= SignalCourse::k_periods * course.period) return std::nullopt;
    return not_acted(use, part);
  }

  // Checks a constant load, which has no end. It has acted if the motion or the utilisations that it causes have become constant before an
  // action ends it. If the run ends it, this is required only if no other load determines the length of the run.
  std::optional<Finding> of_constant(const ActingSignal& use, const std::string& what, const Location& where) const {
    if (!growth_ || use.spans.empty()) return std::nullopt;
    const SignalSpan& last = use.spans.back();
    const bool is_cut = last.cut.action && last.cut.verb != ActionVerb::stop;
    const ElementEntry& entry = model_.elements[use.element];
    if (uses_time(entry) || (!is_cut && (has_course_ || !entry.kind->has_constant_load))) return std::nullopt;
    const auto has_acted = [&](const SignalSpan& span) { // uniform acceleration may continue indefinitely
      return has_settled(span.from, span) || (!is_cut && has_stopped_growing(0.5 * (span.from + span.to), span.to));
    };
    if (std::any_of(use.spans.begin(), use.spans.end(), has_acted)) return std::nullopt;
    return warning("load_too_short", what + " acts from t = " + seconds(last.from) + " on, and " + level_text(use, last), where);
  }

  std::optional<Finding> never_begun(const ActingSignal& use, const std::string& signal, const Location& where) const {
    if (use.waiting.empty() || std::any_of(use.waiting.begin(), use.waiting.end(), [&](const Action* a) { return is_forbidden(*a); }))
      return std::nullopt; // action_findings.h reports elements that no action can start
    const std::string& element = model_.elements[use.element].element->name;
    const std::string what =
        signal.empty() ? "load '" + element + "' has never acted" : "signal '" + signal + "' has never acted on '" + element + "'";
    return warning("load_never_acts",
                   what + ": action '" + use.waiting.front()->name +
                       "' did not happen. Check its condition; if it is an alarm, forbid it by an [[acceptance]] with event = \"happens\"",
                   where);
  }

private:
  // Returns true if a criterion forbids the action. Loads that only this action would start are then not expected to act.
  [[nodiscard]] bool is_forbidden(const Action& action) const {
    return std::any_of(model_.criteria.begin(), model_.criteria.end(), [&](const Criterion& c) {
      return !c.event.empty() && matches_pattern(action.name, c.element.empty() ? "*" : c.element) &&
             event_kinds_matching(c.event).test(static_cast<std::size_t>(EventKind::happens));
    });
  }

  [[nodiscard]] bool has_acted(const SignalSpan& span, const LoadPart& part) const {
    const SignalCourse& course = part.course;
    const double to = span.to + slack_;
    if (span.cut.action && !span.cut.action->reason.empty()) return true; // an action with a reason ends the load intentionally
    if (!(to > course.begins) || !(span.from < course.ends)) return false;
    if (course.has_end() && to >= course.ends && (span.from <= course.begins + slack_ || is_at_full_size(span.from, part))) return true;
    if (!(course.full < to)) return false;
    const double since = std::max(course.full, span.from);
    if (course.period > 0.0) return has_repeated(since, span.to, course.period);
    return !course.has_end() && has_settled(since, span);
  }

  // Returns true if the signal reaches its largest value at or after `from`, the time at which it begins to act.
  static bool is_at_full_size(double from, const LoadPart& part) {
    constexpr double k_nearly = 0.99; // required fraction of the maximum; the sampled peak may be lower by less
    constexpr int k_samples = 16;     // samples between two breakpoints
    std::vector<double> times{part.course.begins, from};
    for (const double t : part.signal->breakpoints())
      if (t > part.course.begins && t <= part.course.ends) times.push_back(t);
    std::sort(times.begin(), times.end());
    double all = 0.0, behind = 0.0;
    for (std::size_t i = 0; i + 1 < times.size(); ++i)
      for (int k = 0; k < k_samples; ++k) {
        const double t = times[i] + (times[i + 1] - times[i]) * (k + 0.5) / k_samples, size = std::abs(part.signal->value(t));
        all = std::max(all, size);
        if (t >= from) behind = std::max(behind, size);
      }
    return behind >= k_nearly * all;
  }

  [[nodiscard]] bool has_repeated(double since, double to, double period) const {
    constexpr double k_least = 2.0;
    const double periods = (to + slack_ - since) / period;
    if (periods >= SignalCourse::k_periods) return true;
    return periods >= k_least && (!growth_ || has_stopped_growing(to - period, to));
  }

  // Returns true if the utilisation of no criterion grew noticeably from `before` to `to`. Returns false if no criterion has a utilisation.
  [[nodiscard]] bool has_stopped_growing(double before, double to) const {
    constexpr double k_less = 0.01;  // growth relative to the utilisation so far
    constexpr double k_still = 1e-6; // growth relative to the reserve at the start, the accuracy of extremes
    for (std::size_t i = 0; i < growth_->count(); ++i) {
      const double left = growth_->reserve(i, to + slack_), first = growth_->first_reserve(i);
      if (!std::isfinite(left) || !std::isfinite(first)) continue;
      if (!(growth_->reserve(i, before) - left <= std::max(k_less * (first - left), k_still * std::abs(first)))) return false;
    }
    return growth_->count() > 0;
  }

  // Returns true if a load at a constant level has had its full effect. If an action ends the load, only the extremes up to then are known,
  // not the motion.
  [[nodiscard]] bool has_settled(double since, const SignalSpan& span) const {
    if (!growth_ || !result_ || (span.cut.action && !span.cut.action->reason.empty())) return true;
    if (span.cut.action && span.cut.verb != ActionVerb::stop)
      return span.to > since && (growth_->count() == 0 || has_stopped_growing(0.5 * (since + span.to), span.to));
    const Motions motions(loaded_, *result_);
    if (motions.rests()) return true;
    if (!has_stopped_growing(0.5 * (since + span.to), span.to)) return false;
    if (motions.is_even()) return true;
    for (std::size_t i = 0; i < growth_->count(); ++i)
      if (growth_->first_reserve(i) > growth_->reserve(i, span.to + slack_)) return true; // the load had an effect
    return false;
  }

  // Returns a finding if a criterion still grows under a periodic load, perhaps without limit (resonance). The rate of growth is that of
  // the second half of the time at full size.
  [[nodiscard]] std::optional<Finding> growing(const SignalSpan& span, const LoadPart& part) const {
    const double since = std::max(part.course.full, span.from), half = 0.5 * (since + span.to);
    const bool is_at_end = !span.cut.action || (span.cut.verb == ActionVerb::stop && span.cut.action->reason.empty());
    if (!growth_ || !is_at_end || part.course.ends <= span.to || !(part.course.period > 0.0) || !(span.to > since)) return std::nullopt;
    for (std::size_t i = 0; i < growth_->count(); ++i) {
      const double left = growth_->reserve(i, span.to + slack_), rate = (growth_->reserve(i, half) - left) / (span.to - half);
      if (!std::isfinite(left) || !(rate > 0.0) || left > rate * span.to) continue;
      return warning("criterion_still_grows",
                     "'" + growth_->limited(i).criterion + "' is met so far, but under signal '" + part.entry->definition->name +
                         "' its value still grows when the run ends: at its present rate it reaches its limit after " +
                         rounded_text(left / rate, 3) + " s more. Let the run go on until it repeats itself",
                     part.entry->definition->where);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string cut_text(const ActingSignal& use, const SignalSpan& span) const {
    if (!span.cut.action) return "the run ends at " + seconds(span.to);
    const std::string& element = model_.elements[use.element].element->name;
    const std::string action = "action '" + span.cut.action->name + "' ";
    switch (span.cut.verb) {
    case ActionVerb::stop: return action + "ends the run at " + seconds(span.to);
    case ActionVerb::set: return action + "sets another signal of '" + element + "' at " + seconds(span.to);
    default: return action + "releases '" + element + "' at " + seconds(span.to);
    }
  }

  static std::string remedy(const SignalSpan& span, const std::string& longer) {
    return span.cut.action ? "Let the action happen later, or say in its 'reason' why the load is meant to end there" : longer;
  }

  [[nodiscard]] std::string level_text(const ActingSignal& use, const SignalSpan& last) const {
    return cut_text(use, last) + ": what it moves has not come to rest by then. " +
           remedy(last, "Let the run go on ('end' of [simulation])");
  }

  [[nodiscard]] Finding not_acted(const ActingSignal& use, const LoadPart& part) const {
    const SignalCourse& course = part.course;
    const Location& where = part.entry->definition->where;
    const std::string name = "signal '" + part.entry->definition->name + "'";
    const SignalSpan& last = use.spans.back();
    const std::string cut = cut_text(use, last), let_run = "Let the run go on ('end' of [simulation])";
    if (last.from >= course.ends)
      return warning("load_never_acts",
                     name + " is over at " + seconds(course.ends) + ", and '" + model_.elements[use.element].element->name +
                         "' begins to act at " + seconds(last.from) + " only: it does nothing",
                     where);
    if (!(last.to > course.begins)) {
      if (!last.cut.action)
        return warning("load_behind_end",
                       name + " begins at t = " + number_text(course.begins) + " s, but the run ends at " + number_text(last.to) +
                           " s: it does nothing",
                       where);
      return warning("load_never_acts",
                     name + " begins at t = " + seconds(course.begins) + ", but " + cut + ": it does nothing. " + remedy(last, ""), where);
    }
    if (course.has_end() && last.to + slack_ >= course.ends)
      return warning("load_cut_off", name + " acts from t = " + seconds(last.from) + " on, and its largest values were before", where);
    if (course.has_end())
      return warning("load_cut_off",
                     name + " lasts from t = " + seconds(course.begins) + " to " + seconds(course.ends) + ", but " + cut +
                         ": only a part of it has acted. " + remedy(last, let_run),
                     where);
    if (course.full >= last.to)
      return warning("load_still_grows",
                     name + " has its full size from t = " + rounded_text(course.full) + " s on, but " + cut +
                         ": it is not judged under the whole load",
                     where);
    if (course.period > 0.0)
      return warning("load_too_short",
                     name + " has acted at its full size for " +
                         rounded_text((last.to - std::max(course.full, last.from)) / course.period, 2) + " of its periods of " +
                         rounded_text(course.period, 3) + " s when " + cut +
                         ", and what it does has not come to repeat itself: ten are asked. " + remedy(last, let_run),
                     where);
    return warning("load_too_short", name + " is level from t = " + seconds(course.full) + " on, and " + level_text(use, last), where);
  }

  const LoadedModel& loaded_;
  const Model& model_;
  double slack_;                 ///< tolerance for times, s
  const ReserveHistory* growth_; ///< null before a run
  const RunResult* result_;      ///< null before a run
  bool has_course_;
};

// Returns true if some load changes with time.
bool have_course(const Model& model, const std::vector<ActingSignal>& uses) {
  Parts parts(model);
  const auto changes = [&](const ActingSignal& use) {
    const std::vector<LoadPart> all = parts.of(use.signal);
    return std::any_of(all.begin(), all.end(), [](const LoadPart& part) { return !part.signal->is_constant(); });
  };
  return std::any_of(uses.begin(), uses.end(), changes) || std::any_of(model.elements.begin(), model.elements.end(), uses_time);
}

std::vector<Finding> findings_of_uses(const LoadedModel& loaded, const std::vector<ActingSignal>& uses, const Judge& judge) {
  Parts parts(loaded.model);
  std::vector<Finding> findings;
  std::unordered_set<std::string> known;
  for (const ActingSignal& use : uses) {
    if (use.signal.empty()) {
      const Element& element = *loaded.model.elements[use.element].element;
      auto finding = use.spans.empty() ? judge.never_begun(use, "", element.where)
                                       : judge.of_constant(use, "load '" + element.name + "'", element.where);
      if (finding) findings.push_back(std::move(*finding));
      continue;
    }
    for (const LoadPart& part : parts.of(use.signal)) {
      auto finding = judge.finding(use, part);
      if (finding && known.insert(part.entry->definition->name).second) findings.push_back(std::move(*finding));
    }
  }
  return findings;
}

// Returns the doubts of the signals that acted, each once.
std::vector<Finding> doubts_of_records(const LoadedModel& loaded, const std::vector<ActingSignal>& uses) {
  Parts parts(loaded.model);
  std::vector<Finding> findings;
  std::unordered_set<std::string> known;
  for (const ActingSignal& use : uses) {
    if (use.signal.empty() || use.spans.empty()) continue;
    for (const LoadPart& part : parts.of(use.signal))
      for (const Signal::Doubt& doubt : part.signal->doubts()) {
        const SignalDefinition& definition = *part.entry->definition;
        if (use.spans.back().to > doubt.t && known.insert(definition.name + doubt.text).second)
          findings.push_back(warning("record_in_doubt", "signal '" + definition.name + "': " + doubt.text, definition.where));
      }
  }
  return findings;
}

} // namespace

std::vector<Finding> loads_beyond_end(const LoadedModel& loaded) {
  const double end = loaded.model.simulation.end;
  return findings_of_uses(loaded, acting_signals_without_actions(loaded.model, end), Judge(loaded, end, nullptr, nullptr, false));
}

namespace {

// Finds pulses without a rise, in a signal or in those of which it is made, that begin exactly at the start of the run.
class SuddenPulses {
public:
  explicit SuddenPulses(const Model& model) : model_(model), network_(model) {}

  [[nodiscard]] const SignalEntry* first_in(const std::string& name) {
    const auto entry =
        std::find_if(model_.signals.begin(), model_.signals.end(), [&](const SignalEntry& each) { return each.definition->name == name; });
    const Signal* const signal = entry == model_.signals.end() ? nullptr : network_.build(name);
    if (!signal || signal->value(0.0) == 0.0) return nullptr;
    if (entry->kind->name == "rectangle" || entry->kind->name == "trapezoid")
      return signal->pieces().front().start == 0.0 ? &*entry : nullptr;
    for (const Field& field : entry->kind->fields.fields()) {
      std::vector<std::string> names;
      if (field.type == FieldType::signal) names = {std::get<std::string>(field.get(entry->definition.get()))};
      if (field.type == FieldType::signals) names = std::get<std::vector<std::string>>(field.get(entry->definition.get()));
      for (const std::string& part : names)
        if (const SignalEntry* const found = first_in(part)) return found;
    }
    return nullptr;
  }
  [[nodiscard]] double at_start(const SignalEntry& entry) { return network_.build(entry.definition->name)->value(0.0); }

private:
  const Model& model_;
  SignalNetwork network_;
};

// Returns true if the signal is a force or couple. Positions that drives prescribe are held in the search for equilibrium, and the pressure
// of a brake has to act there.
bool is_force(const Model& model, const ActingSignal& use) {
  const ElementEntry& entry = model.elements[use.element];
  if (use.field == "formula") return entry.kind->acts_from_outside && entry.kind->acts_from_outside(*entry.element, model);
  const Field* const field = entry.kind->fields.find(use.field);
  return field && field->unit.starts_with("N");
}

} // namespace

std::vector<Finding> pulses_at_rest(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  if (model.simulation.initial != "equilibrium") return {};
  SuddenPulses pulses(model);
  std::vector<Finding> findings;
  std::unordered_set<const SignalEntry*> known;
  for (const ActingSignal& use : acting_signals_without_actions(model, model.simulation.end)) {
    if (use.signal.empty() || use.spans.empty() || !is_force(model, use)) continue;
    const SignalEntry* const pulse = pulses.first_in(use.signal);
    if (!pulse || !known.insert(pulse).second) continue;
    findings.push_back(
        warning("pulse_at_rest",
                "signal '" + pulse->definition->name + "' jumps to " + number_text(pulses.at_start(*pulse)) +
                    " exactly at the start, and the run begins at rest under it, as if it had always acted: it is no blow. A "
                    "blow begins later (start = \"1 ms\"), a load from which the machine is let go before (start = \"-1 s\")",
                pulse->definition->where));
  }
  return findings;
}

std::vector<Finding> loads_not_acted(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement) {
  if (!result.stop_reason.empty()) return {}; // an element that came apart ended the run; the verdict reports it
  const ReserveHistory growth(result,
                              result.growth.empty() ? std::vector<LimitedChannel>{} : limited_channels(loaded.model, result, judgement));
  const std::vector<ActingSignal> uses = acting_signals(loaded.model, result);
  const Judge judge(loaded, result.final_state.t, &growth, &result, have_course(loaded.model, uses));
  std::vector<Finding> findings = findings_of_uses(loaded, uses, judge);
  for (Finding& finding : doubts_of_records(loaded, uses)) findings.push_back(std::move(finding));
  for (Finding& finding : late_formulas(loaded, result)) findings.push_back(std::move(finding));
  return findings;
}

} // namespace steplap
