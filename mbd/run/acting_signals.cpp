#include "mbd/run/acting_signals.h"

#include "mbd/model/formula_fields.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace steplap {

namespace {

// Reconstructs all legs of a run from its events.
class LegFollower {
public:
  explicit LegFollower(const Model& model) : model_(model) {
    for (std::size_t i = 0; i < model.elements.size(); ++i) {
      const ElementEntry& entry = model.elements[i];
      index_[entry.element->name] = i;
      acts_.push_back(entry.element->active);
      for (const Field& field : entry.kind->fields.fields())
        if (field.type == FieldType::signal) name(i, field.name, std::get<std::string>(field.get(entry.element.get())));
      if (entry.kind->has_constant_load && entry.kind->has_constant_load(*entry.element)) now_[{i, ""}] = {&use(i, "", ""), 0.0};
    }
    std::unordered_set<std::string> signals;
    for (const SignalEntry& signal : model.signals) signals.insert(signal.definition->name);
    for (std::size_t i = 0; i < model.elements.size(); ++i)
      for (const std::string& operand : names_in_formulas(model.elements[i]))
        if (signals.contains(operand) && !as_action(*model.elements[i].element))
          now_[{i, "formula " + operand}] = {&use(i, "formula", operand), 0.0};
    for (auto& [key, each] : uses_) each.is_named_at_start = true;
  }

  void happen(const Action& action, double t) {
    for (const std::string& text : action.steps) {
      const ActionStepText step = action_step(text);
      const auto found = index_.find(step.name);
      if (found == index_.end()) continue;
      const std::size_t element = found->second;
      const SignalCut cut{&action, step.verb};
      if (step.verb == ActionVerb::release) set_acting(element, false, t, cut);
      if (step.verb == ActionVerb::hold) set_acting(element, true, t, cut);
      if (step.verb == ActionVerb::set && is_signal(element, step.field)) {
        end(element, step.field, t, cut);
        name(element, step.field, step.value, t);
      } else if (step.verb == ActionVerb::set && model_.elements[element].kind->has_constant_load) {
        if (is_zero(step.value)) {
          end(element, "", t, cut);
          now_.erase({element, ""});
        } else {
          now_.try_emplace({element, ""}, ActingUse{&use(element, "", ""), t});
        }
      }
    }
  }

  // Records the action as one that would have started the loads that its steps name.
  void wait(const Action& action) {
    for (const std::string& text : action.steps) {
      const ActionStepText step = action_step(text);
      const auto found = index_.find(step.name);
      if (found == index_.end()) continue;
      if (step.verb == ActionVerb::set && is_signal(found->second, step.field))
        use(found->second, step.field, step.value).waiting.push_back(&action);
      else if (step.verb == ActionVerb::set && model_.elements[found->second].kind->has_constant_load && !is_zero(step.value))
        use(found->second, "", "").waiting.push_back(&action);
      if (step.verb != ActionVerb::hold) continue;
      for (auto& [key, each] : uses_)
        if (each.element == found->second) each.waiting.push_back(&action);
    }
  }

  std::vector<ActingSignal> finished(double t, const SignalCut& cut) {
    for (std::size_t i = 0; i < acts_.size(); ++i)
      if (acts_[i]) set_acting(i, false, t, cut);
    std::vector<ActingSignal> all;
    for (auto& [key, each] : uses_) all.push_back(std::move(each));
    return all;
  }

private:
  using Place = std::pair<std::size_t, std::string>; // element index and field name
  struct ActingUse {
    ActingSignal* use = nullptr;
    double since = 0.0;
  };

  ActingSignal& use(std::size_t element, const std::string& field, const std::string& signal) {
    ActingSignal& found = uses_[{element, {field, signal}}];
    found.element = element, found.field = field, found.signal = signal;
    return found;
  }

  void name(std::size_t element, const std::string& field, const std::string& signal, double t = 0.0) {
    if (signal.empty()) now_.erase({element, field});
    else now_[{element, field}] = {&use(element, field, signal), t};
  }

  [[nodiscard]] bool is_signal(std::size_t element, const std::string& field) const {
    const Field* const found = model_.elements[element].kind->fields.find(field);
    return found && found->type == FieldType::signal;
  }

  // Returns true for values such as "[0, 0]" and "0 N".
  static bool is_zero(const std::string& value) { return value.find_first_of("123456789=") == std::string::npos; }

  void end(std::size_t element, const std::string& field, double t, const SignalCut& cut) {
    const auto found = now_.find({element, field});
    if (found == now_.end() || !acts_[element]) return;
    std::vector<SignalSpan>& spans = found->second.use->spans;
    // an interval of zero length is kept only as the first one, for the reason of its end
    if (!(t > found->second.since) && !spans.empty()) return;
    // Continues an interval: the field was set to the value that it already had.
    const bool goes_on = !spans.empty() && spans.back().to == found->second.since;
    if (goes_on) spans.back().to = t, spans.back().cut = cut;
    else spans.push_back({found->second.since, t, cut});
  }

  void set_acting(std::size_t element, bool acts, double t, const SignalCut& cut) {
    if (acts_[element] == acts) return;
    for (auto place = now_.lower_bound({element, ""}); place != now_.end() && place->first.first == element; ++place) {
      if (!acts) end(element, place->first.second, t, cut);
      place->second.since = t;
    }
    acts_[element] = acts;
  }

  const Model& model_;
  std::unordered_map<std::string, std::size_t> index_; ///< index of each element by name
  std::vector<bool> acts_;
  std::map<std::pair<std::size_t, std::pair<std::string, std::string>>, ActingSignal> uses_; ///< key: element, field and signal
  std::map<Place, ActingUse> now_;
};

} // namespace

const Action* find_action(const Model& model, const std::string& name) {
  for (const ElementEntry& entry : model.elements)
    if (entry.element->name == name) return as_action(*entry.element);
  return nullptr;
}

std::vector<ActingSignal> acting_signals(const Model& model, const RunResult& result) {
  LegFollower legs(model);
  std::set<const Action*> happened;
  for (const Event& event : result.events) {
    if (event.kind != EventKind::happens) continue;
    const Action* const action = find_action(model, event.element);
    if (!action) continue;
    happened.insert(action);
    legs.happen(*action, event.t);
  }
  for (const ElementEntry& entry : model.elements)
    if (const auto* const action = as_action(*entry.element); action && !happened.contains(action)) legs.wait(*action);
  return legs.finished(result.final_state.t, {find_action(model, result.ended_by), ActionVerb::stop});
}

std::vector<ActingSignal> acting_signals_without_actions(const Model& model, double end) { return LegFollower(model).finished(end, {}); }

} // namespace steplap
