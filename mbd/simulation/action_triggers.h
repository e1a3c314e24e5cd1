// State of the triggers of all actions: armed or not, due or not.
//
// An armed action is due when its condition is true, immediately if it is already true when the action is armed. A condition that remains
// true triggers once; it must become false before it can trigger again. Each occurrence of an event triggers.
#pragma once

#include "mbd/events/event.h"
#include "mbd/system/actions.h"

#include <span>
#include <string>
#include <vector>

namespace steplap {

/// One flag per action of the model.
struct ActionTriggers {
  std::vector<char> is_armed;  ///< the action waits for its condition
  std::vector<char> is_spent;  ///< the condition has been true ever since the action was last executed
  std::vector<char> has_event; ///< the trigger event has occurred since the action was last executed
  std::vector<char> is_due;    ///< the action is due; result of the last update()

  /// Sets the state at the start as the model specifies.
  explicit ActionTriggers(const ActionGroup& group);

  /// Arms an action.
  void arm(std::size_t action);
  /// Disarms an action.
  void disarm(std::size_t action);
  /// Records that an action is executed. It triggers again only after its condition has become false and true again, and, with `is_once`,
  /// after it has been armed again.
  void spend(std::size_t action, bool is_once);
  /// Sets is_due at `state`. Returns true if any action is due. `events`: new events; `is_stepped`: as in ActionGroup::holds.
  bool update(const ActionGroup& group, const System& system, const State& state, bool is_stepped, std::span<const Event> events);

private:
  std::vector<Motion<double>> motion_;
};

} // namespace steplap
