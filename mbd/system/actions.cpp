#include "mbd/system/actions.h"

namespace steplap {

namespace {

template <class S> OwnCoordinate<S> no_coordinate() { return {S(0.0), S(0.0)}; }

} // namespace

template <class S, class AtTime> void ActionGroup::event_value(EvaluationData<S>& e, const AtTime& at_time) const {
  S quantity[k_most_switches];
  for (const ElementData& entry : entries) {
    if (entry.unit < 0) continue;
    const MotionFormula& formula = *entry.trigger.formula;
    const SwitchBits bits = e.mode[entry.unit];
    preset_quantities(formula.program().switch_count(), bits, quantity);
    (void)formula.value(e, no_coordinate<S>(), at_time, bits, quantity);
    switch_events(bits, quantity, entry.trigger.switches, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
  }
}

void ActionGroup::add_forces(Evaluation& e) const { event_value(e, NumericSignalEvaluator{e.t}); }

bool ActionGroup::record_forces(TracedEvaluation& e) const {
  event_value<TapeNumber>(e, TracedSignalEvaluator{e});
  return true;
}

void ActionGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const ElementData& entry : entries)
    if (entry.trigger.formula)
      for (const int body : entry.trigger.formula->bodies()) is_used[body] = 1;
}

void ActionGroup::register_turns(TurnTable& turns) const {
  for (const ElementData& entry : entries)
    if (entry.trigger.formula) entry.trigger.formula->register_turns(turns);
}

UnitMode ActionGroup::initial_mode(int element, const Evaluation& e) const {
  FormulaProgram::Bits bits{0, 0};
  entries[static_cast<std::size_t>(element)].trigger.formula->find_bits(e, no_coordinate<double>(), bits);
  return bits.values;
}

UnitMode ActionGroup::next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const {
  return next_bits(*entries[static_cast<std::size_t>(element)].trigger.formula, mode, slot, e, no_coordinate<double>());
}

bool ActionGroup::holds(std::size_t action, const State& state, const std::vector<Motion<double>>& motion, bool is_stepped) const {
  const ElementData& entry = entries[action];
  if (entry.trigger.time) return state.t >= *entry.trigger.time;
  if (!entry.trigger.formula) return false;
  Evaluation e;
  e.t = state.t;
  e.motion = motion.data();
  e.inner = state.inner.data();
  FormulaProgram::Bits bits{0, 0};
  if (entry.unit >= 0 && !is_stepped) bits = {state.mode[static_cast<std::size_t>(entry.unit)]};
  else entry.trigger.formula->find_bits(e, no_coordinate<double>(), bits);
  return entry.trigger.formula->value<double>(e, no_coordinate<double>(), NumericSignalEvaluator{e.t}, bits.values, nullptr) != 0.0;
}

ActionGroup* action_group(System& system) {
  for (const auto& group : system.groups)
    if (auto* const found = dynamic_cast<ActionGroup*>(group.get())) return found;
  return nullptr;
}

const ActionGroup* action_group(const System& system) {
  for (const auto& group : system.groups)
    if (const auto* const found = dynamic_cast<const ActionGroup*>(group.get())) return found;
  return nullptr;
}

std::string action_met_at(const System& system, const State& state) {
  const ActionGroup* const group = action_group(system);
  if (!group) return "";
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  for (std::size_t i = 0; i < group->entries.size(); ++i)
    if (group->entries[i].is_armed && group->holds(i, state, motion, true)) return group->entries[i].name;
  return "";
}

} // namespace steplap
