// Data of one event while EventHandler handles it: the state before and now, the slots that fired, and intermediate results.
#pragma once

#include "mbd/events/event.h"
#include "mbd/system/system.h"

#include <vector>

namespace steplap {

struct EventTransaction {
  /// Keeps references to the state, the slots and the event list.
  EventTransaction(const System& system, State& state, const std::vector<int>& slots, std::vector<Event>& list)
      : now(state), fired(slots), events(list), friction_before(state.friction), impacts_before(state.impacts),
        has_switched(static_cast<std::size_t>(system.event_count), 0) {}

  State& now;
  const std::vector<int>& fired; ///< slots of the event functions that became negative; empty at a breakpoint of a signal
  std::vector<Event>& events;    ///< receives the events
  const std::vector<FrictionState> friction_before;
  const std::vector<Impact> impacts_before;
  const std::vector<double>* event_value_before = nullptr; ///< at a breakpoint: all event functions just before it; else null
  /// At the event, before any change, and only if two elements stick: event functions; per friction element: it shares a load with others.
  std::vector<double> event_value_at;
  std::vector<char> shares_load_at;

  std::vector<char> has_switched;  ///< per slot: the unit has switched its mode
  bool is_loading_changed = false; ///< normal forces may have begun or ended, because a contact or a signal changed
  bool is_any_tight = false;       ///< a rope has reached its full length
  bool is_any_at_rest = false;     ///< a slip has ended
  bool is_settled = false;         ///< the state satisfies the rows of all sticking elements

  /// Returns the motions of the bodies, computed at the first call. Call velocities_changed() after a change of poses or velocities.
  [[nodiscard]] const Motion<double>* motion() {
    if (!is_placed_) place_bodies(now.q, now.v, motion_);
    is_placed_ = true;
    return motion_.data();
  }
  void velocities_changed() { is_placed_ = false; }

private:
  std::vector<Motion<double>> motion_;
  bool is_placed_ = false;
};

} // namespace steplap
