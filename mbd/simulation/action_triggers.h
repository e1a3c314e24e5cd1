// Which actions of a run are armed, and which of them are due.
//
// An action is due where its condition has come true since it was armed: at once, if it is true there. A condition that is true stays
// one occasion until it has been false. Of an event each is an occasion.
#pragma once

#include "mbd/events/event_handler.h"
#include "mbd/system/actions.h"

#include <span>
#include <string>
#include <vector>

namespace steplap {

/// One flag per action of the model.
struct ActionTriggers {
  std::vector<char> is_armed;  ///< it waits for its condition
  std::vector<char> is_spent;  ///< its condition is true, and has been since it last happened
  std::vector<char> has_event; ///< its event has been, and it has not happened yet
  std::vector<char> is_due;    ///< as looked at last

  /// As the model says at the start.
  explicit ActionTriggers(const ActionGroup& group);

  /// From here on it waits.
  void arm(std::size_t action);
  /// From here on it does not.
  void disarm(std::size_t action);
  /// It happens: no more before its condition comes true anew, nor, if it happens once, before it is armed.
  void spend(std::size_t action, bool is_once);
  /// Is any due at `state`? `events`: those that are new; `is_stepped` as in ActionGroup::holds.
  bool look(const ActionGroup& group, const System& system, const State& state, bool is_stepped, std::span<const Event> events);

private:
  std::vector<Motion<double>> motion_;
};

} // namespace steplap
