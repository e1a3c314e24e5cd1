#include "mbd/simulation/action_triggers.h"

#include <algorithm>

namespace steplap {

ActionTriggers::ActionTriggers(const ActionGroup& group)
    : is_armed(group.entries.size(), 0), is_spent(is_armed), has_event(is_armed), is_due(is_armed) {
  for (std::size_t i = 0; i < is_armed.size(); ++i) is_armed[i] = group.entries[i].is_armed ? 1 : 0;
}

void ActionTriggers::arm(std::size_t action) {
  if (is_armed[action] != 0) return;
  is_armed[action] = 1;
  is_spent[action] = has_event[action] = 0;
}

void ActionTriggers::disarm(std::size_t action) { is_armed[action] = has_event[action] = is_due[action] = 0; }

void ActionTriggers::spend(std::size_t action, bool is_once) {
  is_spent[action] = 1;
  has_event[action] = is_due[action] = 0;
  if (is_once) is_armed[action] = 0;
}

bool ActionTriggers::update(const ActionGroup& group, const System& system, const State& state, bool is_stepped,
                            std::span<const Event> events) {
  place_bodies(state.q, state.v, motion_);
  bool is_any = false;
  for (std::size_t i = 0; i < is_armed.size(); ++i) {
    const ActionTrigger& trigger = group.entries[i].trigger;
    if (trigger.element >= 0) {
      const std::string& name = system.element_names[static_cast<std::size_t>(trigger.element)];
      const bool has_been =
          std::any_of(events.begin(), events.end(), [&](const Event& e) { return e.kind == trigger.event && e.element == name; });
      if (is_armed[i] != 0 && has_been) has_event[i] = 1;
      is_due[i] = has_event[i];
    } else {
      const bool holds = group.holds(i, state, motion_, is_stepped);
      if (!holds) is_spent[i] = 0;
      is_due[i] = static_cast<char>(is_armed[i] != 0 && holds && is_spent[i] == 0);
    }
    is_any = is_any || is_due[i] != 0;
  }
  return is_any;
}

} // namespace steplap
