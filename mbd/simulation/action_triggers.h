// State of the triggers of all actions: armed or not, due or not.
//
// An action is due when its condition becomes true after it was armed, or at once if the condition is true at that time. A condition that
// remains true triggers only once, until it has been false. Each occurrence of an event triggers.
#pragma once

#include "mbd/events/event.h"
#include "mbd/system/actions.h"

#include <span>
#include <string>
#include <vector>

namespace steplap {

/// One flag per action of the model.
struct ActionTriggers {
  std::vector<char> is_armed;  ///< waits for its condition
  std::vector<char> is_spent;  ///< the condition is true and has been since the action was last executed
  std::vector<char> has_event; ///< its event has occurred since the action was last executed
  std::vector<char> is_due;    ///< result of the last update()

  /// Sets the state at the start as the model specifies.
  explicit ActionTriggers(const ActionGroup& group);

  /// Arms an action.
  void arm(std::size_t action);
  /// Disarms an action.
  void disarm(std::size_t action);
  /// To be called when an action is executed. It triggers again only after its condition has become true again, and, with `is_once`, after
  /// it was armed again.
  void spend(std::size_t action, bool is_once);
  /// Returns true if any action is due at `state`, and sets is_due. `events` are the new events; `is_stepped` as in ActionGroup::holds.
  bool update(const ActionGroup& group, const System& system, const State& state, bool is_stepped, std::span<const Event> events);

private:
  std::vector<Motion<double>> motion_;
};

} // namespace steplap
